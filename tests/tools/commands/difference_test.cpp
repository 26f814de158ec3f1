// `cradle diff`. Proves: two results are the same only if everything in them is; each kind of difference is reported
// where it is, with its size; and a tolerance accepts smaller differences and counts them. (What the command prints,
// and its statuses, are in tests/tools/run/outputs.txt.)
#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/commands/difference.hpp"

namespace cradle::tests::difference_test {

using tools::Column;
using tools::Group;
using tools::Result;
using tools::ResultDifferences;

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
  const ResultDifferences none = differences(result(), result(), "A", "B");
  EXPECT_TRUE(none.found.empty());
  EXPECT_EQ(none.numbers, 3U + 3 + 4 + 3) << "three columns, three attributes";
  EXPECT_EQ(none.tolerated, 0U);
}

TEST(Difference, OfDecimalsHasTheirSizeBeyondDouble) {
  const auto of = [](std::vector<std::string> decimals) {
    Result r;
    r.groups.push_back({"exact/series", {}, {Column{"time", "", "", std::move(decimals)}}});
    return r;
  };
  const auto differences_of = [&](const std::string& a, const std::string& b, double rtol = 0) {
    return lines(of({"1", a}), of({"1", b}), rtol);
  };
  const auto found = [](const std::string& what) { return std::vector{"exact/series/time: first in row 1: " + what}; };
  EXPECT_EQ(differences_of("0.99999999999999999999", "1"), found("0.99999999999999999999 against 1 (1e-20 relative)"));
  EXPECT_EQ(differences_of("-3e-4001", "-2.5e-4000"), found("-3e-4001 against -2.5e-4000 (0.88 relative)"));
  EXPECT_EQ(differences_of("1e900", "-1e900"), found("1e900 against -1e900 (2 relative)"));
  EXPECT_EQ(differences_of("0", "1e-900"), found("0 against 1e-900 (1 relative)"));
  EXPECT_EQ(differences_of("1", "collapsed"), found("1 against collapsed"));
  EXPECT_TRUE(differences_of("0.99999999999999999999", "1", 1e-19).empty());
  EXPECT_FALSE(differences_of("0.99999999999999999999", "1", 1e-21).empty());
  EXPECT_TRUE(differences_of("1.00", "1", 1e-300).empty());
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
      {[](Result& r) { r.attributes.emplace_back("more", 1.); }, "@more: only in B"},
      {[](Result& r) { r.groups.pop_back(); }, "snapshots/0000: only in A"},
      {[](Result& r) { r.groups.emplace_back().name = "clusters"; }, "clusters: only in B"},
      {[](Result& r) { r.groups[1].attributes[0].second = 2.; }, "snapshots/0000@time: 1.5 against 2 (0.25 relative)"},
      {[](Result& r) { r.groups[0].columns.pop_back(); }, "series/edges: only in A"},
      {[](Result& r) { r.groups[0].columns[0].unit = "ms"; }, "series/time: unit \"s\" against \"ms\""},
      {[](Result& r) { r.groups[0].columns[0].description = "then"; },
       "series/time: description \"when\" against \"then\""},
      {[](Result& r) { times(r).push_back(3); }, "series/time: 3 rows against 4"},
      {[](Result& r) { r.groups[0].columns[2].width = 1; },
       "series/edges: 2 numbers a row against 1\nseries/edges: 2 rows against 4"},
      {[](Result& r) { r.groups[0].columns[0].values = std::vector<std::uint64_t>(3); },
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
  const ResultDifferences none = differences(result(), near, "A", "B", 1e-9);
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

}  // namespace cradle::tests::difference_test
