// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/measured_curve.h"

#include <gmock/gmock.h>

#include "pressed_organ.h"

namespace palpate::fit::test {
namespace {

using ::testing::HasSubstr;

void expectPoints(const std::string& text, const std::vector<std::array<double, 3>>& wanted) {
  const MeasuredCurve curve = parseCurve("curve.csv", text);
  ASSERT_EQ(curve.points.size(), wanted.size()) << text;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_DOUBLE_EQ(curve.points[i].depth, wanted[i][0]) << text;
    EXPECT_DOUBLE_EQ(curve.points[i].force, wanted[i][1]) << text;
    EXPECT_DOUBLE_EQ(curve.points[i].error, wanted[i][2]) << text;
  }
}

TEST(MeasuredCurve, ColumnsHaveTheirUnits) {
  expectPoints("depth_m,force_N\n0.001,2\n", {{0.001, 2.0, 1.0}});
  expectPoints("depth_mm,force_mN\n-1.5,+2e3\n", {{-0.0015, 2.0, 1.0}});
  expectPoints("force [kN];depth (um)\n2e-3;1000\n", {{0.001, 2.0, 1.0}});
  expectPoints("\"depth/mm\"\t\"force / N\"\n\"1\"\t\"2\"\n", {{0.001, 2.0, 1.0}});
  expectPoints("depth_mm,force_error_mN,force_N\n1,5,2\n", {{0.001, 2.0, 0.005}});
}

TEST(MeasuredCurve, OtherColumnsCommentsAndEmptyLinesAreLeftOut) {
  expectPoints(
      "\xEF\xBB\xBF# of a pig\r\n\r\ntime_s, depth_mm, force_N, forced\r\n0,1,2,yes\r\n# moved\r\n1,3,4,\r\n",
      {{0.001, 2.0, 1.0}, {0.003, 4.0, 1.0}});
}

TEST(MeasuredCurve, NamesOfMoreWordsAreOfOtherColumns) {
  expectPoints("depth_mm,force_N,depth_rate_mm_s\n1,2,3\n", {{0.001, 2.0, 1.0}});
  expectPoints("force_filtered_N,depth_mm,force_N\n9,1,2\n", {{0.001, 2.0, 1.0}});
  expectPoints("depth [mm/s],force_filtered,force [N],depth [mm]\n9,9,2,1\n", {{0.001, 2.0, 1.0}});
}

TEST(MeasuredCurve, NamesHaveNoCase) {
  expectPoints("Depth (mm);Force (N)\n1;2\n", {{0.001, 2.0, 1.0}});
  expectPoints("DEPTH_mm,Force_Error_mN,FORCE_N\n1,5,2\n", {{0.001, 2.0, 0.005}});
}

TEST(MeasuredCurve, RefusesBySayingWhatStandsWhere) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"", "curve.csv has no line that names its columns, such as depth_mm,force_N"},
      {"# nothing\n", "curve.csv has no line that names its columns"},
      {"1,2\n3,4\n",
       "curve.csv, line 1: no column is named depth with its unit, such as depth_mm: found '1,2'"},
      {"depth_mm,load_N\n", "line 1: no column is named force with its unit, such as force_N"},
      {"depth,force_N\n", "line 1: column 'depth' has no unit, expected one of m, mm, um"},
      {"# a\ndepth_inch,force_N\n",
       "line 2: column 'depth_inch' has the unit 'inch', expected one of m, mm, um"},
      {"depth_mm,force_lbf\n", "column 'force_lbf' has the unit 'lbf', expected one of N, mN, kN"},
      {"depth_rate_mm,force_N\n", "line 1: no column is named depth with its unit"},
      {"depth_MM,force_N\n", "column 'depth_MM' has the unit 'MM', expected one of m, mm, um"},
      {"depth_mm,force_N,force_error_lbf\n", "column 'force_error_lbf' has the unit 'lbf'"},
      {"Depth (mm),depth_mm,force_N\n", "line 1: two columns are depth: 'Depth (mm)' and 'depth_mm'"},
      {"depth_mm,force_N,depth_m\n", "line 1: two columns are depth: 'depth_mm' and 'depth_m'"},
      {"depth_mm,force_N\n1\n", "line 2: has 1 columns, expected 'force_N' in column 2"},
      {"depth_mm,force_N\n1,nan\n", "line 2: column 'force_N' is 'nan', expected a finite number"},
      {"depth_mm,force_N\n1,2\n\ninf,2\n", "line 4: column 'depth_mm' is 'inf', expected a finite number"},
      {"depth_mm;force_N\n0,5;2\n",
       "column 'depth_mm' is '0,5', expected a finite number with a decimal point"},
      {"depth_mm,force_N\n1,\n", "line 2: column 'force_N' is '', expected a finite number"},
      {"depth_mm,force_N\n1,2 N\n", "line 2: column 'force_N' is '2 N', expected a finite number"},
      {"depth_mm,force_N,force_error_N\n1,2,0\n",
       "column 'force_error_N' is '0', expected a standard error above 0"}};
  for (const auto& [text, message] : wrong)
    EXPECT_THAT(errorOf([&] { (void)parseCurve("curve.csv", text); }), HasSubstr(message)) << text;
}

TEST(MeasuredCurve, RefusesAFileThatIsNone) {
  const palpate::testing::TemporaryFolder folder;
  const auto missing = folder / "none.csv";
  EXPECT_EQ(errorOf([&] { (void)readCurve(missing); }),
            "cannot read " + missing.string() + ": No such file or directory");
  EXPECT_EQ(errorOf([&] { (void)readCurve(folder.path()); }),
            "cannot read " + folder.path().string() + ": Is a directory");
}

}  // namespace
}  // namespace palpate::fit::test
