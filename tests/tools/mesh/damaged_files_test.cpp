// SPDX-License-Identifier: Apache-2.0
// Whatever happens to a file, a reader answers with a mesh or one line of text.
#include <random>

#include "helpers.h"
#include "samples.h"
#include "tools/mesh/read_mesh.h"
#include "tools/mesh/topology.h"
#include "tools/mesh/write_msh.h"

namespace palpate::mesh::test {
namespace {

class DamagedFile : public ::testing::TestWithParam<std::pair<std::string, std::string>> {};

bool survives(const std::filesystem::path& file) {
  const std::string message = errorOf([&] { (void)readMesh(file); });
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_TRUE(message.empty() || message.starts_with(file.string())) << message;
  return message.empty();
}

TEST_P(DamagedFile, CutAnywhereIsRefusedUnlessOnlyTheTailIsGone) {
  const auto& [name, text] = GetParam();
  const TemporaryFolder folder;
  // Past the last tetrahedron's last digit there is nothing that a reader needs.
  std::size_t taken = 0;
  for (std::size_t size = 0; size < text.size(); ++size)
    taken += survives(folder.write(name, text.substr(0, size))) ? 1 : 0;
  EXPECT_LT(taken, text.size() / 4);
}

TEST_P(DamagedFile, RandomBytesNeverCrashAReader) {
  const auto& [name, text] = GetParam();
  const TemporaryFolder folder;
  std::mt19937 random(20);
  std::uniform_int_distribution<std::size_t> place(0, text.size() - 1);
  std::uniform_int_distribution<int> byte(0, 255);
  std::size_t refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string damaged = text;
    for (int k = 0; k <= i % 4; ++k) damaged[place(random)] = static_cast<char>(byte(random));
    refused += survives(folder.write(name, damaged)) ? 0 : 1;
  }
  EXPECT_GT(refused, 0U);
}

TEST_P(DamagedFile, RandomDigitsNeverCrashAReader) {
  const auto& [name, text] = GetParam();
  const TemporaryFolder folder;
  std::mt19937 random(21);
  std::uniform_int_distribution<std::size_t> place(0, text.size() - 1);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = text;
    const std::size_t digit = text.find_first_of("0123456789", place(random));
    if (digit == std::string::npos) continue;
    damaged.replace(digit, 1, i % 3 == 0 ? "-1" : i % 3 == 1 ? "99999999999" : std::to_string(i % 10));
    survives(folder.write(name, damaged));
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedFile,
                         ::testing::Values(std::pair("1.msh", kMsh1),
                                           std::pair("2.msh", kMsh2.substr(0, kMsh2.find("$NodeData"))),
                                           std::pair("4.msh", kMsh4),
                                           std::pair("3.vtk", kVtk.substr(0, kVtk.find("CELL_DATA"))),
                                           std::pair("5.vtk", kVtk5), std::pair("a.mesh", kMedit)));

}  // namespace
}  // namespace palpate::mesh::test
