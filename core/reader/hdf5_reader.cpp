// SPDX-License-Identifier: Apache-2.0
// In core, this file and main.cpp beside it alone include HDF5.
#include "core/reader/hdf5_reader.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/data/datasets.h"

namespace palpate {

namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);
static_assert(std::endian::native == std::endian::little,
              "the model file is mapped as it is: little-endian only");

/// What HDF5 says about its last error, at the place where it met it.
std::string lastError() {
  std::string reason = "unknown reason";
  const auto keep = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    if (error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep, &reason);  // from the call to the cause: the last one stays
  return reason;
}

/// Lets HDF5's core driver read the image where it lies, without a copy of its own: a sealed memory file
/// cannot be opened by name (HDF5 resolves /proc/self/fd/N to a path, and there is none). Read-only, so
/// nothing is written to it.
H5FD_file_image_callbacks_t inPlace(const std::byte* image) {
  H5FD_file_image_callbacks_t callbacks{};
  callbacks.image_malloc = [](std::size_t, H5FD_file_image_op_t, void* self) -> void* { return self; };
  callbacks.image_memcpy = [](void* to, const void*, std::size_t, H5FD_file_image_op_t, void*) { return to; };
  callbacks.image_realloc = [](void*, std::size_t, H5FD_file_image_op_t, void*) -> void* { return nullptr; };
  callbacks.image_free = [](void*, H5FD_file_image_op_t, void*) -> herr_t { return 0; };
  callbacks.udata_copy = [](void* self) { return self; };
  callbacks.udata_free = [](void*) -> herr_t { return 0; };
  callbacks.udata = const_cast<std::byte*>(image);
  return callbacks;
}

/// HDF5's type for numbers as a model file holds them.
Hdf5Handle fileType(NumberType type) {
  const auto of = [](hid_t known) { return Hdf5Handle(H5Tcopy(known), H5Tclose); };
  switch (type) {
    case NumberType::kF64:
      return of(H5T_IEEE_F64LE);
    case NumberType::kF32:
      return of(H5T_IEEE_F32LE);
    case NumberType::kI8:
      return of(H5T_STD_I8LE);
    case NumberType::kI16:
      return of(H5T_STD_I16LE);
    case NumberType::kI32:
      return of(H5T_STD_I32LE);
    case NumberType::kI64:
      return of(H5T_STD_I64LE);
    case NumberType::kU8:
      return of(H5T_STD_U8LE);
    case NumberType::kRegionName:
      break;
  }
  Hdf5Handle text = of(H5T_C_S1);
  H5Tset_size(text.get(), sizeof(RegionName));
  H5Tset_strpad(text.get(), H5T_STR_NULLPAD);
  return text;
}

std::string describeType(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_STRING) return "text";
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) return "neither integer nor floating point";
  const std::string order = H5Tget_order(type) == H5T_ORDER_BE ? "big-endian " : "little-endian ";
  const std::string sign = kind == H5T_INTEGER && H5Tget_sign(type) == H5T_SGN_NONE ? "unsigned " : "";
  return order + std::to_string(8 * H5Tget_size(type)) + "-bit " + sign +
         (kind == H5T_INTEGER ? "integer" : "float");
}

}  // namespace

Hdf5Reader::Hdf5Reader(std::span<const std::byte> file, ModelAnswer& answer)
    : ModelSource(""), image_(file), answer_(answer), file_(openImage()) {}

Hdf5Handle Hdf5Reader::openImage() const {
  static constexpr std::array<unsigned char, 8> kSignature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  const auto bytes = image_;
  if (bytes.size() < kSignature.size() ||
      std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0)
    fail("does not begin with the HDF5 signature, expected a model file");
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5FD_file_image_callbacks_t callbacks = inPlace(bytes.data());
  constexpr std::size_t kIncrement = 1U << 16U;  // of a file that grows; this one does not
  const bool ready = H5Pset_fapl_core(access.get(), kIncrement, 0) >= 0 &&
                     H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0 &&
                     H5Pset_file_image(access.get(), const_cast<std::byte*>(bytes.data()), bytes.size()) >= 0;
  if (!ready) fail("HDF5 cannot read from memory (" + lastError() + ")");
  Hdf5Handle file(H5Fopen("/palpate-model", H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!file.valid())
    fail("HDF5 cannot open its " + std::to_string(bytes.size()) +
         " bytes, the file is truncated or damaged (" + lastError() + ")");
  return file;
}

bool Hdf5Reader::hasAttribute(const char* attribute) const {
  return H5Aexists(file_.get(), attribute) > 0;
}

bool Hdf5Reader::hasDataset(const std::string& path) const {
  return H5Lexists(file_.get(), path.substr(0, path.find('/')).c_str(), H5P_DEFAULT) > 0 &&
         H5Lexists(file_.get(), path.c_str(), H5P_DEFAULT) > 0;
}

Hdf5Handle Hdf5Reader::openAttribute(const char* attribute, int values) const {
  Hdf5Handle handle(H5Aopen(file_.get(), attribute, H5P_DEFAULT), H5Aclose);
  if (!handle.valid()) fail(std::string("attribute ") + attribute + " is missing");
  const Hdf5Handle space(H5Aget_space(handle.get()), H5Sclose);
  if (!space.valid() || H5Sget_simple_extent_npoints(space.get()) != values)
    fail(std::string("attribute ") + attribute +
         (values == 1 ? " is not a single value" : " is not " + std::to_string(values) + " values"));
  return handle;
}

void Hdf5Reader::numbers(const char* attribute, std::span<double> values) const {
  const Hdf5Handle handle = openAttribute(attribute, static_cast<int>(values.size()));
  const Hdf5Handle type(H5Aget_type(handle.get()), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_FLOAT || H5Aread(handle.get(), H5T_NATIVE_DOUBLE, values.data()) < 0)
    fail(std::string("attribute ") + attribute + " is " + describeType(type.get()) + ", expected a float");
  answer_.addNumbers(attribute, values);
}

int Hdf5Reader::integer(const char* attribute) const {
  const Hdf5Handle handle = openAttribute(attribute, 1);
  const Hdf5Handle type(H5Aget_type(handle.get()), H5Tclose);
  int value = 0;  // HDF5 saturates larger integers, so that a huge one stays out of range
  if (H5Tget_class(type.get()) != H5T_INTEGER || H5Aread(handle.get(), H5T_NATIVE_INT, &value) < 0)
    fail(std::string("attribute ") + attribute + " is " + describeType(type.get()) + ", expected an integer");
  const double number = value;
  answer_.addNumbers(attribute, {&number, 1});
  return value;
}

std::string Hdf5Reader::text(const char* attribute) const {
  constexpr std::size_t kMaxFixedText = 65536;  // more does not fit an object header
  const Hdf5Handle handle = openAttribute(attribute, 1);
  const Hdf5Handle type(H5Aget_type(handle.get()), H5Tclose);
  const std::string refusal = std::string("attribute ") + attribute + " is no readable text";
  if (H5Tget_class(type.get()) != H5T_STRING) fail(refusal);
  if (H5Tis_variable_str(type.get()) > 0) {
    char* value = nullptr;
    if (H5Aread(handle.get(), type.get(), static_cast<void*>(&value)) < 0) fail(refusal);
    std::string copy(value == nullptr ? "" : value);
    H5free_memory(value);
    answer_.addText(attribute, copy);
    return copy;
  }
  const std::size_t size = H5Tget_size(type.get());
  if (size > kMaxFixedText) fail(refusal);
  std::vector<char> value(size + 1, '\0');
  if (H5Aread(handle.get(), type.get(), value.data()) < 0) fail(refusal);
  answer_.addText(attribute, value.data());
  return value.data();
}

/// A soft or external link would lead out of the copy that is checked.
void Hdf5Reader::checkLink(const std::string& path) const {
  H5L_info_t info{};
  if (H5Lexists(file_.get(), path.c_str(), H5P_DEFAULT) <= 0) fail("/" + path + " is missing");
  if (H5Lget_info(file_.get(), path.c_str(), &info, H5P_DEFAULT) < 0 || info.type != H5L_TYPE_HARD)
    fail("/" + path + " is a link to somewhere else, expected the data in this file");
}

Hdf5Handle Hdf5Reader::openDataset(const std::string& path) const {
  checkLink(path.substr(0, path.find('/')));
  checkLink(path);
  Hdf5Handle handle(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!handle.valid()) fail("/" + path + " is no readable dataset");
  return handle;
}

ArrayShape Hdf5Reader::shape(const std::string& path, NumberType wanted) const {
  const Hdf5Handle dataset = openDataset(path);
  const Hdf5Handle found(H5Dget_type(dataset.get()), H5Tclose);
  ArrayShape out{wanted, {}};
  const auto is = [&](NumberType type) { return H5Tequal(found.get(), fileType(type).get()) > 0; };
  for (const NumberType type : {NumberType::kI8, NumberType::kI16, NumberType::kI32, NumberType::kF32})
    if (isNarrower(type, wanted) && is(type)) out.type = type;
  if (!found.valid() || !is(out.type))
    fail("/" + path + " is " + describeType(found.get()) + ", expected " +
         describeType(fileType(wanted).get()));
  const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::array<hsize_t, H5S_MAX_RANK> lengths{};
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr);
  out.lengths.assign(lengths.begin(), lengths.begin() + std::max(rank, 0));
  shape_ = out;
  return out;
}

void Hdf5Reader::checkLayout(const std::string& path, hid_t dataset) const {
  const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  if (!creation.valid()) fail("/" + path + " has no readable layout");
  if (const int filters = H5Pget_nfilters(creation.get()); filters != 0)
    fail("/" + path + " has " + std::to_string(filters) +
         " filters (compression or the like), expected none");
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  if (layout != H5D_CONTIGUOUS)
    fail("/" + path + " is " +
         (layout == H5D_CHUNKED   ? "chunked"
          : layout == H5D_COMPACT ? "compact"
                                  : "virtual") +
         ", expected contiguous");
  if (H5Pget_external_count(creation.get()) != 0)
    fail("/" + path + " lies in another file, expected the data in this file");
}

const std::byte* Hdf5Reader::place(const std::string& path, std::uint64_t bytes) const {
  answer_.addArray(path, shape_, offsetOf(path, bytes));
  return nullptr;
}

std::uint64_t Hdf5Reader::offsetOf(const std::string& path, std::uint64_t bytes) const {
  const Hdf5Handle dataset = openDataset(path);
  checkLayout(path, dataset.get());
  if (bytes == 0) return 0;
  const std::uint64_t size = image_.size();
  const haddr_t offset = H5Dget_offset(dataset.get());
  if (offset == HADDR_UNDEF)
    fail("/" + path + " has no place in the file (late allocation), expected early allocation");
  if (offset > size || bytes > size - offset)
    fail("/" + path + " lies at bytes " + std::to_string(offset) + " + " + std::to_string(bytes) +
         ", expected within the file's " + std::to_string(size));
  if (const std::uint64_t stored = H5Dget_storage_size(dataset.get()); stored != bytes)
    fail("/" + path + " stores " + std::to_string(stored) + " bytes, expected " + std::to_string(bytes));
  if (offset % kArrayAlignment != 0)
    fail("/" + path + " begins at byte " + std::to_string(offset) + ", expected a multiple of " +
         std::to_string(kArrayAlignment));
  return offset;
}

}  // namespace palpate
