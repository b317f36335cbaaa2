# SPDX-License-Identifier: Apache-2.0
"""What tools/latency-report is made of."""
