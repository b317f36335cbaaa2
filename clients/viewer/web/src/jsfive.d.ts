// SPDX-License-Identifier: Apache-2.0
declare module 'jsfive'; // core/wasm/organ.mjs alone looks inside
