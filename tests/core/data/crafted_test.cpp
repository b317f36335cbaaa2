// SPDX-License-Identifier: Apache-2.0
// HDF5 files that are crafted: sizes, addresses and counts of HDF5's own structures that its readers have overflowed on, and
// features that lead out of the file. https://github.com/HDFGroup/hdf5, CVE_list_1_10.md
#include <gtest/gtest.h>
#include <hdf5.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <functional>
#include <set>

#include "../load_case.h"
#include "palpate/testing/sanitizers.h"

namespace palpate::testing {

namespace {

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class T>
T numberAt(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

const std::string& goodBytes() {
  static const std::string bytes = [] {
    const TemporaryFile file("good.h5");
    modelfile::writeModel(file.path(), goodData());
    return contentOf(file.path());
  }();
  return bytes;
}

std::string complaintOfBytes(const std::string& bytes) {
  const TemporaryFile file("crafted.h5");
  std::ofstream(file.path(), std::ios::binary) << bytes;
  return complaint(file.path());
}

/// What is said of a file is not that no process could be started to parse it.
void expectParsed(const std::string& text) {
  for (const char* other :
       {"no process can be started", "cannot lock", "cannot run here", "not to be believed"})
    EXPECT_EQ(text.find(other), std::string::npos) << text;
}

/// The root group's object header, by the superblock (version 0): its version, messages, references, size, then messages.
std::size_t rootHeader() {
  return numberAt<std::uint64_t>(goodBytes(), 64);
}

constexpr std::uint16_t kContinuation = 0x10, kSymbolTable = 0x11;

/// The first message of a kind in the root's object header and where that goes on: kind, size, flags and so on, then its bytes.
std::size_t message(std::uint16_t wanted) {
  const std::string& bytes = goodBytes();
  std::size_t at = rootHeader() + 16, end = at + numberAt<std::uint32_t>(bytes, rootHeader() + 8);
  for (std::size_t next = 0, next_end = 0; at + 8 <= end;) {
    const auto kind = numberAt<std::uint16_t>(bytes, at), size = numberAt<std::uint16_t>(bytes, at + 2);
    if (kind == wanted) return at;
    if (kind == kContinuation) {
      next = numberAt<std::uint64_t>(bytes, at + 8);
      next_end = next + numberAt<std::uint64_t>(bytes, at + 16);
    }
    at += 8 + size;
    if (at + 8 > end) at = next, end = next_end, next = next_end = 0;
  }
  throw std::runtime_error("the root has no message of kind " + std::to_string(wanted));
}

constexpr std::uint64_t kAll = ~std::uint64_t{0};

struct Craft {
  std::string name;
  std::function<void(std::string&)> spoil;
};

class CraftedBytes : public ::testing::TestWithParam<Craft> {};

TEST_P(CraftedBytes, AreRefusedInOneLine) {
  std::string bytes = goodBytes();
  GetParam().spoil(bytes);
  ASSERT_NE(bytes, goodBytes());
  const std::string text = complaintOfBytes(bytes);
  EXPECT_NE(text, "");
  expectParsed(text);
  // HDF5 1.10.8 writes over its heap, and reads where nothing is. AddressSanitizer sees more of that, and ends the process itself.
  static const std::set<std::string> kEndTheProcess{"HeapOfAllBytes", "TextLongerThanItsCollection"};
  const bool ended = text.find("the process that parses it ended ") != std::string::npos;
  const bool expected = kEndTheProcess.count(GetParam().name) > 0;
  EXPECT_TRUE(ended == expected || (ended && testing::kSanitized)) << text;
  RecordProperty("refusal", text);
}

template <class T>
Craft at(const char* name, const std::function<std::size_t()>& where, T value) {
  return {name, [=](std::string& bytes) { put(bytes, where(), value); }};
}

std::function<std::size_t()> behind(const char* signature, std::size_t offset) {
  return [=] { return goodBytes().find(signature) + offset; };
}

std::function<std::size_t()> inRoot(std::size_t offset) {
  return [=] { return rootHeader() + offset; };
}

std::function<std::size_t()> inMessage(std::uint16_t kind, std::size_t offset) {
  return [=] { return message(kind) + offset; };
}

std::function<std::size_t()> fixed(std::size_t offset) {
  return [=] { return offset; };
}

std::vector<Craft> crafts() {
  using U8 = std::uint8_t;
  using U16 = std::uint16_t;
  using U32 = std::uint32_t;
  const auto itself = [](const char* name, const std::function<std::size_t()>& where,
                         const std::function<std::size_t()>& what) {
    return Craft{name, [=](std::string& bytes) { put(bytes, where(), std::uint64_t{what()}); }};
  };
  return {
      at<U8>("SuperblockOfAnotherVersion", fixed(8), 255),
      at<U8>("AddressesOf255Bytes", fixed(13), 255),
      at<U8>("AddressesOfNoBytes", fixed(13), 0),
      at<U8>("LengthsOf255Bytes", fixed(14), 255),
      at<U16>("SymbolLeavesOfNothing", fixed(16), 0),
      at("BaseBeyondTheFile", fixed(24), std::uint64_t{1} << 62U),
      at("FileThatEndsAtNoAddress", fixed(40), kAll - 1),
      at("RootBeyondTheFile", fixed(64), std::uint64_t{1} << 40U),
      itself("RootThatIsTheSuperblock", fixed(64), fixed(0)),
      at<U8>("HeaderOfAnotherVersion", inRoot(0), 99),
      at<U32>("HeaderOf4GiB", inRoot(8), ~0U),
      at<U32>("HeaderOfNothing", inRoot(8), 0),
      at<U16>("MessageOf64KiB", inMessage(kSymbolTable, 2), 65528),
      at("TreeBeyondTheFile", inMessage(kSymbolTable, 8), kAll - 8),
      itself("TreeThatIsTheHeader", inMessage(kSymbolTable, 8), rootHeader),
      at("HeapBeyondTheFile", inMessage(kSymbolTable, 16), kAll - 8),
      itself("HeapThatIsTheTree", inMessage(kSymbolTable, 16), behind("TREE", 0)),
      at("ContinuationBeyondTheFile", inMessage(kContinuation, 8), kAll - 64),
      at("ContinuationWithoutEnd", inMessage(kContinuation, 16), kAll - 64),
      itself("ContinuationThatIsItself", inMessage(kContinuation, 8), inMessage(kContinuation, 0)),
      at<U8>("TreeOfAnotherKind", behind("TREE", 4), 1),
      at<U8>("TreeOf255Levels", behind("TREE", 5), 255),
      at<U16>("TreeOf65535Children", behind("TREE", 6), 65535),
      at("ChildBeyondTheFile", behind("TREE", 32), kAll - 8),
      itself("ChildThatIsTheHeap", behind("TREE", 32), behind("HEAP", 0)),
      at("HeapOfAllBytes", behind("HEAP", 8), kAll - 1),
      at("HeapOfNoBytes", behind("HEAP", 8), std::uint64_t{0}),
      at("FreeListBeyondItsHeap", behind("HEAP", 16), std::uint64_t{1} << 40U),
      at("HeapsDataBeyondTheFile", behind("HEAP", 24), kAll - 8),
      at<U16>("SymbolNodeOf65535", behind("SNOD", 6), 65535),
      at("NameBeyondItsHeap", behind("SNOD", 8), std::uint64_t{1} << 40U),
      at("ObjectBeyondTheFile", behind("SNOD", 16), kAll - 8),
      itself("ObjectThatIsItsOwnNode", behind("SNOD", 16), behind("SNOD", 0)),
      at("CollectionOfAllBytes", behind("GCOL", 8), kAll - 1),
      at("CollectionOfNoBytes", behind("GCOL", 8), std::uint64_t{0}),
      at("TextLongerThanItsCollection", behind("GCOL", 24), kAll - 32),
  };
}

std::string nameOf(const ::testing::TestParamInfo<Craft>& info) {
  return info.param.name;
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(All, CraftedBytes, ::testing::ValuesIn(crafts()), nameOf);

/// Each field of superblock, root header, and the first of each structure with a signature, made extreme: what HDF5 says of
/// these is refused or read, in one line and in time. Some bytes are not looked at.
TEST(CraftedFields, NoneOfAllHarms) {
  std::set<std::size_t> fields;
  const auto add = [&](std::size_t begin, std::size_t bytes) {
    for (std::size_t at = begin; at < begin + bytes; at += 4) fields.insert(at);
  };
  add(8, 88);
  add(rootHeader(), 128);
  for (const char* signature : {"TREE", "HEAP", "SNOD", "GCOL"}) add(goodBytes().find(signature) + 4, 44);
  int refused = 0, read = 0;
  const auto before = std::chrono::steady_clock::now();
  for (const std::size_t at : fields)
    for (const std::uint32_t value : {0U, ~0U, 0x7FFFFFF8U}) {
      std::string bytes = goodBytes();
      put(bytes, at, value);
      const std::string text = complaintOfBytes(bytes);
      ++(text.empty() ? read : refused);
      expectParsed(text);
    }
  const std::chrono::duration<double> each = std::chrono::steady_clock::now() - before;
  EXPECT_GT(refused, 100) << "of " << refused + read;
  EXPECT_GT(read, 10) << "of " << refused + read;
  RecordProperty("refused", refused);
  RecordProperty("seconds", std::to_string(each.count()));
}

namespace {

/// HDF5 that is well-formed and leads elsewhere.
struct Elsewhere : LoadCase {
  std::function<void(const Hdf5Handle& file)> make;
};

class CraftedToLeadElsewhere : public ::testing::TestWithParam<Elsewhere> {};

TEST_P(CraftedToLeadElsewhere, IsRefusedInOneLine) {
  const TemporaryFile file("elsewhere.h5");
  modelfile::writeModel(file.path(), goodData());
  {
    const Hdf5Handle open = openForSpoiling(file.path());
    H5Lmove(open.get(), "contact/force", open.get(), "old", H5P_DEFAULT, H5P_DEFAULT);
    GetParam().make(open);
  }
  expectRefused(file.path(), GetParam().expected);
}

void makeForce(const Hdf5Handle& file, const std::function<void(hid_t creation, hid_t space)>& prepare) {
  const std::array<hsize_t, 3> shape{goodData().contact_node.size(), 19, 3};
  const Hdf5Handle space(H5Screate_simple(3, shape.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  prepare(creation.get(), space.get());
  const Hdf5Handle data(H5Dcreate2(file.get(), "contact/force", H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                   creation.get(), H5P_DEFAULT),
                        H5Dclose);
  ASSERT_TRUE(data.valid());
}

void filterByPlugin(hid_t creation, hid_t) {
  constexpr H5Z_filter_t kBlosc = 32001;
  const std::array<hsize_t, 3> chunk{1, 19, 3};
  H5Pset_chunk(creation, 3, chunk.data());
  H5Pset_filter(creation, kBlosc, H5Z_FLAG_OPTIONAL, 0, nullptr);
}

void fromAnotherFile(hid_t creation, hid_t space) {
  H5Pset_virtual(creation, space, "/tmp/other.h5", "force", space);
}

void linkToItself(const Hdf5Handle& file) {
  H5Lcreate_soft("/contact/force", file.get(), "contact/force", H5P_DEFAULT, H5P_DEFAULT);
}

void linkToItsGroup(const Hdf5Handle& file) {
  H5Lcreate_hard(file.get(), "contact", file.get(), "contact/force", H5P_DEFAULT, H5P_DEFAULT);
}

void linkGroupToARoot(const Hdf5Handle& file) {
  H5Ldelete(file.get(), "contact", H5P_DEFAULT);
  H5Lcreate_hard(file.get(), "/", file.get(), "contact", H5P_DEFAULT, H5P_DEFAULT);
}

void linkGroupToAnotherFile(const Hdf5Handle& file) {
  H5Ldelete(file.get(), "contact", H5P_DEFAULT);
  H5Lcreate_external("/tmp/other.h5", "/contact", file.get(), "contact", H5P_DEFAULT, H5P_DEFAULT);
}

/// Both names lead to one dataset of the same shape: the numbers of one would be taken for the other's.
void oneForTwo(const Hdf5Handle& file) {
  H5Lmove(file.get(), "old", file.get(), "contact/force", H5P_DEFAULT, H5P_DEFAULT);
  H5Ldelete(file.get(), "contact/series_radius", H5P_DEFAULT);
  H5Lcreate_hard(file.get(), "contact/domain_radius", file.get(), "contact/series_radius", H5P_DEFAULT,
                 H5P_DEFAULT);
}

std::vector<Elsewhere> elsewheres() {
  return {
      {{"FilterByPlugin", "/contact/force has 1 filters"},
       [](const auto& file) { makeForce(file, filterByPlugin); }},
      {{"VirtualDataset", "/contact/force is virtual, expected contiguous"},
       [](const auto& file) { makeForce(file, fromAnotherFile); }},
      {{"LinkToItself", "/contact/force is a link to somewhere else"}, linkToItself},
      {{"LinkToItsGroup", "/contact/force is no readable dataset"}, linkToItsGroup},
      {{"GroupThatIsTheRoot", "/contact/node is missing"}, linkGroupToARoot},
      {{"GroupInAnotherFile", "/contact is a link to somewhere else"}, linkGroupToAnotherFile},
      {{"OneForTwo", "/contact/domain_radius and /contact/series_radius lie in the same bytes"}, oneForTwo},
  };
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(All, CraftedToLeadElsewhere, ::testing::ValuesIn(elsewheres()), kCaseName);

}  // namespace palpate::testing
