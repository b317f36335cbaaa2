// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "core/base/whole_numbers.h"
#include "core/data/datasets.h"
#include "core/data/hdf5_handle.h"

namespace palpate::modelfile {

/// Types of the file, which are those in memory too: little-endian.
inline Hdf5Handle copyOf(hid_t type) {
  return {H5Tcopy(type), H5Tclose};
}
inline Hdf5Handle typeOf(double) {
  return copyOf(H5T_IEEE_F64LE);
}
inline Hdf5Handle typeOf(float) {
  return copyOf(H5T_IEEE_F32LE);
}
inline Hdf5Handle typeOf(std::int16_t) {
  return copyOf(H5T_STD_I16LE);
}
inline Hdf5Handle typeOf(std::int32_t) {
  return copyOf(H5T_STD_I32LE);
}
inline Hdf5Handle typeOf(std::int64_t) {
  return copyOf(H5T_STD_I64LE);
}
inline Hdf5Handle typeOf(std::int8_t) {
  return copyOf(H5T_STD_I8LE);
}
inline Hdf5Handle typeOf(std::uint8_t) {
  return copyOf(H5T_STD_U8LE);
}
inline Hdf5Handle typeOf(const RegionName&) {
  Hdf5Handle text = copyOf(H5T_C_S1);
  H5Tset_size(text.get(), sizeof(RegionName));
  H5Tset_strpad(text.get(), H5T_STR_NULLPAD);
  return text;
}

template <typename T>
Hdf5Handle typeInMemory(std::span<const T>) {
  return typeOf(T{});
}
inline Hdf5Handle typeInMemory(const WholeNumbers& values) {
  return values.int8() != nullptr ? typeOf(std::int8_t{}) : typeOf(std::int16_t{});
}

template <typename T>
const void* placeOf(std::span<const T> values) {
  return values.data();
}
inline const void* placeOf(const WholeNumbers& values) {
  return values.asBytes().data();
}

/// Whether numbers stay what they are in another type.
template <typename Narrow, typename T>
bool fit(std::span<const T> values) {
  return std::all_of(values.begin(), values.end(), [](T number) {
    return number >= static_cast<T>(std::numeric_limits<Narrow>::lowest()) &&
           number <= static_cast<T>(std::numeric_limits<Narrow>::max()) &&
           static_cast<T>(static_cast<Narrow>(number)) == number;
  });
}

/// Calls with(a number of the type that an array is stored in): of fewest bytes, where data are compact.
template <typename T, class With>
auto asStored(std::span<const T> values, bool compact, const With& with) {
  if constexpr (std::is_same_v<T, double>) {
    if (compact && fit<float>(values)) return with(float{});
  } else if constexpr (std::is_integral_v<T> && sizeof(T) > 1) {
    if (compact && fit<std::int8_t>(values)) return with(std::int8_t{});
    if (compact && sizeof(T) > 2 && fit<std::int16_t>(values)) return with(std::int16_t{});
    if (compact && sizeof(T) > 4 && fit<std::int32_t>(values)) return with(std::int32_t{});
  }
  return with(T{});
}

/// The same of numbers that have as few already.
template <class With>
auto asStored(const WholeNumbers& values, bool compact, const With& with) {
  if (values.int8() != nullptr) return with(std::int8_t{});
  return asStored(std::span(values.int16(), values.size()), compact, with);
}

}  // namespace palpate::modelfile
