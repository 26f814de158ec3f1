// `cradle diff`. Proves: two results are the same only if everything in them is; each kind of difference is reported
// where it is, with its size; a tolerance accepts smaller differences and counts them; and the command's statuses.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/result/difference.hpp"

namespace cradle::tests::difference_test {

using tools::Column;
using tools::Differences;
using tools::Group;
using tools::Result;

constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

Result result() {
  Result r;
  r.attributes = {{"scene", "[run]\nuntil = 10\n"}, {"collisions", std::uint64_t{7}}, {"energy", 2.5}};
  r.groups.push_back({"series",
                      {},
                      {Column{"time", "s", "when", std::vector<double>{0, 1, 2}},
                       Column{"particles", "", "how many", std::vector<std::uint64_t>{4, 5, 6}},
                       Column{"edges", "", "of bins", std::vector<double>{1, 2, 3, nan}, 2}}});
  r.groups.push_back({"snapshots/0000", {{"time", 1.5}}, {}});
  return r;
}
std::vector<double>& times(Result& r) { return std::get<std::vector<double>>(r.groups[0].columns[0].values); }

std::vector<std::string> lines(const Result& a, const Result& b, double rtol = 0) {
  std::vector<std::string> found;
  for (const auto& [place, what, size] : differences(a, b, "A", "B", rtol).found) found.push_back(place + ": " + what);
  return found;
}

TEST(Difference, OfAResultAndItselfIsNone) {
  const Differences none = differences(result(), result(), "A", "B");
  EXPECT_TRUE(none.found.empty());
  EXPECT_EQ(none.numbers, 3U + 3 + 4 + 3) << "three columns, three attributes";
  EXPECT_EQ(none.tolerated, 0U);
}

TEST(Difference, OfEachKindIsReportedWithItsPlace) {
  const struct {
    std::function<void(Result&)> change;
    std::string reported;
  } kinds[] = {
      {[](Result& r) { r.attributes[0].second = "[run]\nuntil = 11\n"; },
       "@scene: line 2: \"until = 10\" against \"until = 11\""},
      {[](Result& r) { r.attributes[0].second = "[run]\nuntil = 10"; }, "@scene: line 2: not the same end"},
      {[](Result& r) { r.attributes[1].second = std::uint64_t{9}; }, "@collisions: 7 against 9 (by 2)"},
      {[](Result& r) { r.attributes[1].second = 7.; },
       "@collisions: text, real or whole number against another of these"},
      {[](Result& r) { r.attributes[2].second = std::nextafter(2.5, 3.); },
       "@energy: 2.5 against 2.5000000000000004 (1 ULPs, 1.8e-16 relative)"},
      {[](Result& r) { r.attributes.pop_back(); }, "@energy: only in A"},
      {[](Result& r) {
         r.attributes.push_back({"more", 1.});
       },
       "@more: only in B"},
      {[](Result& r) { r.groups.pop_back(); }, "snapshots/0000: only in A"},
      {[](Result& r) {
         r.groups.push_back({"clusters", {}, {}});
       },
       "clusters: only in B"},
      {[](Result& r) { r.groups[1].attributes[0].second = 2.; }, "snapshots/0000@time: 1.5 against 2 (0.25 relative)"},
      {[](Result& r) { r.groups[0].columns.pop_back(); }, "series/edges: only in A"},
      {[](Result& r) { r.groups[0].columns[0].unit = "ms"; }, "series/time: unit \"s\" against \"ms\""},
      {[](Result& r) { r.groups[0].columns[0].description = "then"; },
       "series/time: description \"when\" against \"then\""},
      {[](Result& r) { times(r).push_back(3); }, "series/time: 3 rows against 4"},
      {[](Result& r) { r.groups[0].columns[2].width = 1; },
       "series/edges: 2 numbers a row against 1\nseries/edges: 2 rows against 4"},
      {[](Result& r) {
         r.groups[0].columns[0].values = std::vector<std::uint64_t>{0, 1, 2};
       },
       "series/time: real numbers, whole ones or text against another of these"},
      {[](Result& r) { times(r)[1] = 1.5, times(r)[2] = 4; },
       "series/time: first in row 1: 1 against 1.5 (0.33 relative); 2 of 3 numbers differ, by up to 0.5 relative"},
      {[](Result& r) { times(r)[0] = -0.; }, "series/time: first in row 0: 0 against -0 (0 ULPs, 0 relative)"},
      {[](Result& r) { times(r)[2] = nan; }, "series/time: first in row 2: 2 against nan"},
      {[](Result& r) { std::get<std::vector<double>>(r.groups[0].columns[2].values)[3] = inf; },
       "series/edges: first in row 1: nan against inf"},
  };
  for (const auto& kind : kinds) {
    Result changed = result();
    kind.change(changed);
    std::string reported;
    for (const std::string& line : lines(result(), changed)) reported += (reported.empty() ? "" : "\n") + line;
    EXPECT_EQ(reported, kind.reported);
    EXPECT_EQ(lines(changed, result()).size(), lines(result(), changed).size());
  }
}

TEST(Difference, WithinAToleranceIsCounted) {
  Result near = result(), far = result();
  times(near)[2] = 2 + 1e-9;
  times(far)[0] = 1e-300;
  const Differences none = differences(result(), near, "A", "B", 1e-9);
  EXPECT_TRUE(none.found.empty());
  EXPECT_EQ(none.tolerated, 1U);
  EXPECT_EQ(lines(result(), near, 1e-10).size(), 1U);
  EXPECT_EQ(lines(result(), far, 0.5).size(), 1U) << "nothing is near 0, relatively";
  times(near)[2] = inf;
  EXPECT_EQ(lines(result(), near, 0.5).size(), 1U);
  EXPECT_TRUE(lines(near, near, 0.5).empty());
}

TEST(Difference, InUnitsInTheLastPlace) {
  EXPECT_EQ(tools::ulps_between(1, std::nextafter(1., 2.)), 1U);
  EXPECT_EQ(tools::ulps_between(0., -0.), 0U);
  EXPECT_EQ(tools::ulps_between(std::nextafter(0., -1.), std::nextafter(0., 1.)), 2U);
  EXPECT_EQ(tools::ulps_between(-1, 1), 2 * tools::ulps_between(0, 1));
  EXPECT_EQ(tools::ulps_between(std::numeric_limits<double>::max(), inf), 1U);
}

class Diff : public ProgramTest {
 protected:
  Printed run(const std::string& file, const std::string& more = "") const {
    return shell(
        "cradle run fig2 --quiet --set initial.particles=100 --set run.until=60 --set output.series.points=5 " + more +
        " -o " + file);
  }
};

TEST_F(Diff, StatusIsThatOfAComparison) {
  ASSERT_EQ(run("a.h5").status, 0);
  ASSERT_EQ(run("b.h5", "--threads 2").status, 0);
  ASSERT_EQ(run("c.h5", "--set run.precision=double-double").status, 0);
  const Printed same = shell("cradle diff a.h5 b.h5"), other = shell("cradle diff a.h5 c.h5");
  EXPECT_EQ(same.status, 0) << same.out;
  EXPECT_TRUE(begins(same.out, "no difference: "));
  EXPECT_EQ(other.status, 1);
  EXPECT_TRUE(has(other.out, "\nscene: run.precision = \"double\" against \"double-double\"\n")) << other.out;
  EXPECT_TRUE(has(other.out, "\n  @scene: line "));
  EXPECT_TRUE(has(other.out, "\n  series/energy: first in row "));
  const Printed loose = shell("cradle diff a.h5 c.h5 --rtol 1e-9");
  EXPECT_EQ(loose.status, 1) << "precision is in the scene";
  EXPECT_FALSE(has(loose.out, "series/energy:"));
  EXPECT_TRUE(has(loose.out, "within --rtol 1e-9"));
}

// Runs of different scenes: a summary of a line for each part, without ULPs; and every place, when wanted.
TEST_F(Diff, OfDifferentRunsIsAPage) {
  ASSERT_EQ(run("a.h5", "--set output.snapshots=[20,40,60]").status, 0);
  ASSERT_EQ(run("b.h5", "--set output.snapshots=[20,40,60] --set initial.seed=2 --set law.cutoff=").status, 0);
  const Printed found = shell("cradle diff a.h5 b.h5", 1);
  for (const auto* line : {"\nscene: law.cutoff = 1e-5 against 0\n", "\nscene: initial.seed = 1 against 2\n",
                           "\nsnapshots: ", "numbers by up to "})
    EXPECT_TRUE(has(found.out, line)) << found.out;
  EXPECT_FALSE(has(found.out, "ULPs")) << found.out;
  const auto lines_of = [](const Printed& printed) { return std::count(printed.out.begin(), printed.out.end(), '\n'); };
  EXPECT_LT(lines_of(found), 12) << found.out;
  const std::string count = found.out.substr(0, found.out.find(' '));
  EXPECT_TRUE(begins(found.out, count + " differences (--all lists them): ")) << found.out;
  const Printed all = shell("cradle diff a.h5 b.h5 --all", 1);
  EXPECT_TRUE(has(all.out, "\n  snapshots/0000/gap: ")) << all.out;
  EXPECT_EQ(std::to_string(lines_of(all) - lines_of(found)), count) << all.out;
}

TEST_F(Diff, RefusesWhatItCannotCompare) {
  ASSERT_EQ(run("a.h5").status, 0);
  shell("cradle diff a.h5 missing.h5", 4);
  for (const std::string rtol : {"-1", "nan", "1e-9x", "inf"}) {
    const Printed refused = shell("cradle diff a.h5 a.h5 --rtol=" + rtol, 2);
    EXPECT_TRUE(has(refused.err, "--rtol: not a tolerance (found " + rtol + ")"));
  }
}

}  // namespace cradle::tests::difference_test
