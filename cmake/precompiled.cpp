// SPDX-License-Identifier: Apache-2.0
// Nothing but the headers that CMakeLists.txt puts before it.
