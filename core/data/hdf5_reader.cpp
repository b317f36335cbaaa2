// SPDX-License-Identifier: Apache-2.0
// The one file of core that knows HDF5.
#include "core/data/hdf5_reader.h"

#include <hdf5.h>

#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/data/load_error.h"

namespace palpate {

namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);
static_assert(std::endian::native == std::endian::little,
              "the model file is mapped as it is: little-endian only");

constexpr std::uint64_t kAlignment = 4096;
constexpr std::uint64_t kMaxLength =
    std::numeric_limits<std::int32_t>::max() / 4;  // int arithmetic on 3 n is safe

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
H5FD_file_image_callbacks_t inPlace(const SealedImage& image) {
  H5FD_file_image_callbacks_t callbacks{};
  callbacks.image_malloc = [](std::size_t, H5FD_file_image_op_t, void* self) -> void* {
    return const_cast<std::byte*>(static_cast<const SealedImage*>(self)->bytes().data());
  };
  callbacks.image_memcpy = [](void* to, const void*, std::size_t, H5FD_file_image_op_t, void*) { return to; };
  callbacks.image_realloc = [](void*, std::size_t, H5FD_file_image_op_t, void*) -> void* { return nullptr; };
  callbacks.image_free = [](void*, H5FD_file_image_op_t, void*) -> herr_t { return 0; };
  callbacks.udata_copy = [](void* self) { return self; };
  callbacks.udata_free = [](void*) -> herr_t { return 0; };
  callbacks.udata = const_cast<SealedImage*>(&image);
  return callbacks;
}

/// HDF5's type for T as a model file holds it.
template <typename T>
Hdf5Handle fileType() {
  const auto of = [](hid_t type) { return Hdf5Handle(H5Tcopy(type), H5Tclose); };
  if constexpr (std::is_same_v<T, double>) return of(H5T_IEEE_F64LE);
  if constexpr (std::is_same_v<T, float>) return of(H5T_IEEE_F32LE);
  if constexpr (std::is_same_v<T, std::int16_t>) return of(H5T_STD_I16LE);
  if constexpr (std::is_same_v<T, std::int32_t>) return of(H5T_STD_I32LE);
  if constexpr (std::is_same_v<T, std::int64_t>) return of(H5T_STD_I64LE);
  if constexpr (std::is_same_v<T, std::uint8_t>) return of(H5T_STD_U8LE);
  if constexpr (std::is_same_v<T, RegionName>) {
    Hdf5Handle text = of(H5T_C_S1);
    H5Tset_size(text.get(), sizeof(T));
    H5Tset_strpad(text.get(), H5T_STR_NULLPAD);
    return text;
  }
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

Hdf5Silence::Hdf5Silence() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Silence::~Hdf5Silence() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

Hdf5Reader::Hdf5Reader(const SealedImage& image, std::string name)
    : image_(image), name_(std::move(name)), file_(openImage()) {}

void Hdf5Reader::fail(const std::string& what) const {
  throw LoadError(name_ + ": " + what);
}

Hdf5Handle Hdf5Reader::openImage() const {
  static constexpr std::array<unsigned char, 8> kSignature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  const auto bytes = image_.bytes();
  if (bytes.size() < kSignature.size() ||
      std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0)
    fail("does not begin with the HDF5 signature, expected a model file");
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5FD_file_image_callbacks_t callbacks = inPlace(image_);
  constexpr std::size_t kIncrement = 1U << 16U;  // of a file that grows; this one does not
  const bool ready = H5Pset_fapl_core(access.get(), kIncrement, 0) >= 0 &&
                     H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0 &&
                     H5Pset_file_image(access.get(), const_cast<std::byte*>(bytes.data()), bytes.size()) >= 0;
  if (!ready) fail("HDF5 cannot read from memory (" + lastError() + ")");
  Hdf5Handle file(H5Fopen("palpate-model", H5F_ACC_RDONLY, access.get()), H5Fclose);
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
}

double Hdf5Reader::number(const char* attribute) const {
  double value = 0.0;
  numbers(attribute, {&value, 1});
  return value;
}

int Hdf5Reader::integer(const char* attribute) const {
  const Hdf5Handle handle = openAttribute(attribute, 1);
  const Hdf5Handle type(H5Aget_type(handle.get()), H5Tclose);
  int value = 0;  // HDF5 saturates larger integers, so that a huge one stays out of range
  if (H5Tget_class(type.get()) != H5T_INTEGER || H5Aread(handle.get(), H5T_NATIVE_INT, &value) < 0)
    fail(std::string("attribute ") + attribute + " is " + describeType(type.get()) + ", expected an integer");
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
    return copy;
  }
  const std::size_t size = H5Tget_size(type.get());
  if (size > kMaxFixedText) fail(refusal);
  std::vector<char> value(size + 1, '\0');
  if (H5Aread(handle.get(), type.get(), value.data()) < 0) fail(refusal);
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

void Hdf5Reader::checkShape(const std::string& path, hid_t dataset, std::span<Length* const> wanted) const {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::array<hsize_t, H5S_MAX_RANK> found{};
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), found.data(), nullptr);
  bool good = rank == static_cast<int>(wanted.size());
  for (std::size_t i = 0; good && i < wanted.size(); ++i) {
    if (wanted[i]->value == Length::kUnknown && found[i] <= kMaxLength) wanted[i]->value = found[i];
    good = wanted[i]->value == found[i];
  }
  if (good) return;
  std::string is, should;
  for (int i = 0; i < rank; ++i)
    is += (i > 0 ? " x " : "") + std::to_string(found[static_cast<std::size_t>(i)]);
  for (const Length* length : wanted) should += (should.empty() ? "" : " x ") + length->text();
  fail("/" + path + " has shape " + (rank > 0 ? is : "of no array") + ", expected " + should);
}

void Hdf5Reader::checkType(const std::string& path, hid_t dataset, hid_t wanted) const {
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  if (!type.valid() || H5Tequal(type.get(), wanted) <= 0)
    fail("/" + path + " is " + describeType(type.get()) + ", expected " + describeType(wanted));
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

const std::byte* Hdf5Reader::place(const std::string& path, hid_t dataset, std::uint64_t bytes) const {
  const std::uint64_t size = image_.bytes().size();
  const haddr_t offset = H5Dget_offset(dataset);
  if (offset == HADDR_UNDEF)
    fail("/" + path + " has no place in the file (late allocation), expected early allocation");
  if (offset > size || bytes > size - offset)
    fail("/" + path + " lies at bytes " + std::to_string(offset) + " + " + std::to_string(bytes) +
         ", expected within the file's " + std::to_string(size));
  if (H5Dget_storage_size(dataset) != bytes)
    fail("/" + path + " stores " + std::to_string(H5Dget_storage_size(dataset)) + " bytes, expected " +
         std::to_string(bytes));
  if (offset % kAlignment != 0)
    fail("/" + path + " begins at byte " + std::to_string(offset) + ", expected a multiple of " +
         std::to_string(kAlignment));
  return image_.bytes().data() + offset;
}

template <typename T>
std::span<const T> Hdf5Reader::dataset(const Dataset<T>& what, Lengths& lengths) const {
  const std::string path = what.path;
  const Hdf5Handle handle = openDataset(path);
  std::vector<Length*> shape;
  for (const char* symbol : what.shape)
    if (symbol != nullptr) shape.push_back(&lengths[symbol]);
  checkType(path, handle.get(), fileType<T>().get());
  checkShape(path, handle.get(), shape);
  checkLayout(path, handle.get());
  const std::uint64_t limit = image_.bytes().size() / sizeof(T);
  std::uint64_t count = 1;
  for (const Length* length : shape) {
    if (length->value != 0 && count > limit / length->value)
      fail("/" + path + " has more numbers than the file's " + std::to_string(image_.bytes().size()) +
           " bytes can hold");
    count *= length->value;
  }
  if (count == 0) return {};
  return {static_cast<const T*>(static_cast<const void*>(place(path, handle.get(), count * sizeof(T)))),
          static_cast<std::size_t>(count)};
}

template std::span<const double> Hdf5Reader::dataset(const Dataset<double>&, Lengths&) const;
template std::span<const float> Hdf5Reader::dataset(const Dataset<float>&, Lengths&) const;
template std::span<const std::int16_t> Hdf5Reader::dataset(const Dataset<std::int16_t>&, Lengths&) const;
template std::span<const std::int32_t> Hdf5Reader::dataset(const Dataset<std::int32_t>&, Lengths&) const;
template std::span<const std::int64_t> Hdf5Reader::dataset(const Dataset<std::int64_t>&, Lengths&) const;
template std::span<const std::uint8_t> Hdf5Reader::dataset(const Dataset<std::uint8_t>&, Lengths&) const;
template std::span<const RegionName> Hdf5Reader::dataset(const Dataset<RegionName>&, Lengths&) const;

Length& Lengths::operator[](const char* symbol) {
  const bool number = std::string_view(symbol).find_first_not_of("0123456789") == std::string_view::npos;
  const auto [entry, added] =
      lengths_.try_emplace(symbol, number ? Length(std::stoull(symbol)) : Length(symbol));
  return entry->second;
}

void Lengths::define(const char* symbol, std::uint64_t value) {
  lengths_.insert_or_assign(symbol, Length(value));
}

}  // namespace palpate
