// The program from scene to file: the Fig. 2 shock from a list of particles against counts of an independent
// event-driven N-particle program (identical in double, binary128 and 100 digits), the three-particle collapse against
// its closed form, and the bits of result files.

#include <algorithm>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/result/reader.hpp"

namespace cradle::tests {
namespace run_test {

using tools::read_result;

class Run : public ProgramTest {
 protected:
  // x_i = (2i - N + 1)/2 + ((h & 0x3FFFF) - 131072)/2^28, exact in decimals of 28 and fewer places.
  void write_shock(int n) const {
    std::string csv = "x,v\n";
    for (int i = 0; i < n; ++i) {
      const auto units =
          static_cast<double>(static_cast<std::int64_t>(hash(static_cast<std::uint64_t>(i)) & 0x3FFFF) - 131072);
      csv += fmt::format("{:.28f},{}\n", (2 * i - n + 1) / 2.0 + units / 268435456.0, i < n / 2 ? "0.5" : "-0.5");
    }
    write("particles.csv", csv);
    write("shock.toml", R"(
[law]
type = "inelastic"
restitution = 0.999
cutoff = 1e-5
[initial]
type = "list"
file = "particles.csv"
[run]
until = 6000
[output]
series = { times = [999.5, 1999, 4000, 6000] }
)");
  }

  void expect_published_counts(const std::string& coordinates) const {
    const Printed run = shell("cradle run shock.toml -o shock.h5 --set run.coordinates=" + coordinates);
    ASSERT_EQ(run.status, 0) << run.err;
    const auto result = read_result((folder / "shock.h5").string());
    const auto& columns = result.find("series")->columns;
    const auto& named = [&](const std::string& name) -> const tools::Numbers& {
      for (const auto& column : columns)
        if (column.name == name) return column.values;
      throw std::out_of_range(name);
    };
    EXPECT_EQ(std::get<std::vector<std::uint64_t>>(named("collisions")),
              (std::vector<std::uint64_t>{384155, 1299216, 4685816, 16156905}));
    const std::vector<double> energies{887.274363235560075, 738.145120941488556, 492.025770085541422,
                                       262.948286528987387};
    for (std::size_t k = 0; k < energies.size(); ++k)
      EXPECT_NEAR(std::get<std::vector<double>>(named("energy"))[k], energies[k], 1e-12 * 1000) << k;
  }
};

TEST_F(Run, ListOfTheFig2ShockGivesThePublishedCountsInGaps) {
  write_shock(8000);
  expect_published_counts("gaps");
}

TEST_F(Run, ListOfTheFig2ShockGivesThePublishedCountsInAbsoluteCoordinates) {
  write_shock(8000);
  expect_published_counts("absolute");
}

TEST_F(Run, CollapseIsFollowedToUnderflowAndItsTimeReported) {
  const Printed run = shell("cradle run collapse3");
  EXPECT_EQ(run.status, 3);
  const auto at = run.out.find("t_c = ");
  ASSERT_NE(at, std::string::npos) << run.out;
  EXPECT_NEAR(std::stod(run.out.substr(at + 6)), 12.0 / 7.0, 1e-15);
  const auto result = read_result((folder / "collapse3.h5").string());
  const auto& collapse = result.find("collapse")->attributes;
  EXPECT_LT(tools::attribute<double>(collapse, "gap", ""), 1e-290);
  EXPECT_GT(tools::attribute<double>(collapse, "gap", ""), 0.0);
  // Intervals at one gap shrink by (lam-/lam+)^2 = (5/16)^2.
  EXPECT_NEAR(tools::attribute<double>(collapse, "ratio", ""), 25.0 / 256.0, 1e-14);
}

TEST_F(Run, CollapseStopsOnceItsTimeIsSettled) {
  const Printed run = shell("cradle run collapse3 --set run.stop_gap= --quiet");
  EXPECT_EQ(run.status, 3);
  const auto result = read_result((folder / "collapse3.h5").string());
  const auto& collapse = result.find("collapse")->attributes;
  EXPECT_NEAR(tools::attribute<double>(collapse, "time", ""), 12.0 / 7.0, 1e-15);
  EXPECT_GT(tools::attribute<double>(collapse, "gap", ""), 1e-30);
  EXPECT_NE(run.out.find("t_c = "), std::string::npos) << "the report is printed under --quiet too";
}

TEST_F(Run, AbsoluteCoordinatesSayWhereTheyStopResolvingACollapse) {
  const Printed run = shell("cradle run collapse3 --set run.coordinates=absolute");
  EXPECT_EQ(run.status, 5);
  EXPECT_NE(run.err.find("gaps below 1e6 units in the last place of x"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("first at t = 1.7142"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("resolution exhausted"), std::string::npos) << run.err;
}

TEST_F(Run, PlainLawWithoutAPolicyAgainstCollapseEndsInsteadOfHanging) {
  const Printed run = shell("cradle run collapse3 --set run.stop_gap= --set run.collapse=cutoff");
  EXPECT_EQ(run.status, 5);
  EXPECT_NE(run.err.find("resolution exhausted"), std::string::npos) << run.err;
}

TEST_F(Run, EveryPrecisionReportsTheCollapseTimeToItsLastDigits) {
  // 12/7 = 1.(714285): as many digits as the type has, its last one or two left to rounding.
  const std::string exact =
      "1.714285714285714285714285714285714285714285714285714285714285714285714285714285714285714285";
  const std::vector<std::pair<std::string, std::size_t>> digits{{"double", 15},
                                                                {"'long double'", 18},
                                                                {"double-double", 30},
#ifdef CRADLE_WITH_FLOAT128
                                                                {"float128", 32},
#endif
                                                                {"cpp_bin_float", 90},
                                                                {"mpfr --set run.digits=20", 19},
                                                                {"mpfr --set run.digits=80", 79}};
  for (const auto& [precision, right] : digits) {
    const Printed run = shell("cradle run collapse3 --set run.precision=" + precision);
    EXPECT_EQ(run.status, 3) << precision << run.err;
    EXPECT_NE(run.out.find("t_c = " + exact.substr(0, right - 1)), std::string::npos) << precision << "\n" << run.out;
  }
}

TEST_F(Run, CollapseIsFollowedBelowTheRangeOfDouble) {
  const Printed run =
      shell("cradle run collapse3 --set run.precision=mpfr --set run.digits=40 --set run.stop_gap=1e-2000");
  EXPECT_EQ(run.status, 3) << run.err;
  EXPECT_NE(run.out.find("e-2001 beside it"), std::string::npos) << run.out;
}

TEST_F(Run, PoliciesAgainstCollapseReachTheEnd) {
  for (const auto* policy : {"contact-time --set run.contact_time=1e-6", "merge --set run.merge_speed=1e-3"})
    EXPECT_EQ(shell(std::string("cradle run collapse3 --set run.stop_gap= --set run.collapse=") + policy).status, 0)
        << policy;
}

TEST_F(Run, TrustSaysThatDoubleInGapsIsRightToUnderflow) {
  const Printed trust = shell("cradle trust collapse3 --both");
  EXPECT_EQ(trust.status, 0) << trust.err;
  const auto line = [&](const std::string& begin) {
    const auto at = trust.out.find(begin);
    return at == std::string::npos ? std::string() : trust.out.substr(at, trust.out.find('\n', at) - at);
  };
  EXPECT_NE(line("double            gaps").find("(end)"), std::string::npos) << trust.out;
  EXPECT_EQ(line("double            absolute").find("(end)"), std::string::npos) << trust.out;
  EXPECT_EQ(shell("cradle plot collapse3-trust.h5").status, 0);
}

TEST_F(Run, TrustedTimesOfAChaoticSceneRiseWithDigits) {
  write("wet.toml", R"(
[law]
type = "wet"
loss = 0.01
[initial]
type = "rows"
particles = 20000
speed = 0.5
perturbation = 0.0005
[run]
until = 19500
[output]
series = { every = 500 }
)");
  ASSERT_EQ(shell("cradle trust wet.toml --digits 16,31,50,100,200").status, 0);
  const auto result = read_result((folder / "wet-trust.h5").string());
  std::vector<double> times;
  for (const auto& group : result.groups)
    times.push_back(tools::attribute<double>(group.attributes, "collisions_right_until", ""));
  ASSERT_EQ(times.size(), 5U);
  EXPECT_LT(times[0], times[1]);
  EXPECT_LT(times[1], times[2]);
  EXPECT_LT(times[2], times[3]);
  EXPECT_EQ(times[3], 19500) << "100 digits reach the end";
}

const std::string overflowing = "law = { type = 'inelastic', restitution = 0.9 }\nrun.until = 1e-160\n"
                                "initial = { type = 'list', x = [0, 1, 2], v = [1e160, -1e160, -2e160] }\n"
                                "output.series.points = 3\n";

// What the type does not hold is refused; what a double does not hold is infinite where doubles are, and has all its
// digits below /exact.
TEST_F(Run, EnergiesThatOverflow) {
  write("a.toml", overflowing);
  const Printed refused = shell("cradle run a.toml -o a.h5");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find(
                "a: initial: the particles cannot be set up (found the kinetic energy of all particles overflows "
                "(found no finite number): give smaller masses or speeds, or a scalar type of a wider range)"),
            std::string::npos)
      << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.h5"));

  ASSERT_EQ(shell("cradle run a.toml --quiet -o a.h5 --set run.precision=mpfr").status, 0);
  const auto result = read_result((folder / "a.h5").string());
  const auto column = [&](const char* table) {
    for (const auto& one : result.find(table)->columns)
      if (one.name == "energy") return one.values;
    throw std::out_of_range(table);
  };
  const auto energy = std::get<std::vector<double>>(column("series"));
  EXPECT_EQ(energy, std::vector<double>(3, std::numeric_limits<double>::infinity()));
  EXPECT_EQ(std::get<std::vector<std::string>>(column("exact/series"))[0].substr(0, 4), "3.00");
  EXPECT_TRUE(std::get<std::vector<std::string>>(column("exact/series"))[0].ends_with("e320"));

  const Printed ensemble = shell("cradle ensemble a.toml --replicas 2 -o e.h5 --set run.precision=mpfr");
  EXPECT_EQ(ensemble.status, 5);
  EXPECT_NE(ensemble.err.find("replica 0 failed: a number beyond the range of a double"), std::string::npos)
      << ensemble.err;
}

TEST_F(Run, PositionsThatOverflowEndIt) {
  write("a.toml", "law = { type = 'inelastic', restitution = 0.9 }\nrun.until = 1e200\n"
                  "initial = { type = 'list', x = [0, 1], v = [0, 1e150] }\noutput.series.points = 3\n"
                  "output.snapshots = [1e200]\n");
  const Printed run = shell("cradle run a.toml -o a.h5");
  EXPECT_EQ(run.status, 5);
  EXPECT_NE(run.err.find("a: a position beyond the range of double (found at t = 1e+200): give an earlier run.until"),
            std::string::npos)
      << run.err;
}

// The time of a checkpoint is that of the run's precision, which has fewer digits than a double here.
TEST_F(Run, OfFewDigitsIsGoneOnWith) {
  ASSERT_EQ(
      shell("cradle run fig2 --quiet --set run.precision=mpfr --set run.digits=10 --set initial.particles=20 --set "
            "run.until=10.1 --set output.snapshots=[] --set output.profiles.times=[] -o a.h5")
          .status,
      0);
  const Printed resumed = shell("cradle resume a.h5 --until 20");
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(shell("cradle resume a.h5 --until 3_0").status, 2);
}

constexpr const char* small_shock = "cradle run fig2 --quiet --set initial.particles=600 --set run.until=400 "
                                    "--set output.snapshots=[100,400] --set output.profiles.times=[50,200] ";

TEST_F(Run, TwoRunsGiveTheSameBytes) {
  ASSERT_EQ(shell(std::string(small_shock) + "-o a.h5").status, 0);
  ASSERT_EQ(shell("sleep 1.1 && " + std::string(small_shock) + "-o b.h5").status, 0);
  EXPECT_FALSE(contents(folder / "a.h5").empty());
  EXPECT_EQ(contents(folder / "a.h5"), contents(folder / "b.h5"));
}

TEST_F(Run, OutputCadenceChangesNothingElse) {
  ASSERT_EQ(shell(std::string(small_shock) + "--set output.series.points=10 -o a.h5").status, 0);
  ASSERT_EQ(shell(std::string(small_shock) + "--set output.series.points=10000 -o b.h5").status, 0);
  const auto a = read_result((folder / "a.h5").string()), b = read_result((folder / "b.h5").string());
  ASSERT_EQ(a.groups.size(), b.groups.size());
  const auto bits = [](const tools::Numbers& values) {
    return std::visit(
        [](const auto& v) {
          return v.empty() ? std::string()
                           : std::string(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(v[0]));
        },
        values);
  };
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    ASSERT_EQ(a.groups[g].name, b.groups[g].name);
    EXPECT_EQ(a.groups[g].attributes, b.groups[g].attributes);
    for (std::size_t c = 0; c < a.groups[g].columns.size(); ++c) {
      const auto &of_a = a.groups[g].columns[c], &of_b = b.groups[g].columns[c];
      ASSERT_EQ(of_a.name, of_b.name);
      if (a.groups[g].name != "series") {
        EXPECT_EQ(bits(of_a.values), bits(of_b.values)) << a.groups[g].name << "/" << of_a.name;
        continue;
      }
      // Both have the first and the last sample.
      std::visit(
          [&](const auto& v) {
            const auto& w = std::get<std::remove_cvref_t<decltype(v)>>(of_b.values);
            EXPECT_EQ(std::memcmp(&v.front(), &w.front(), sizeof(v.front())), 0) << of_a.name;
            EXPECT_EQ(std::memcmp(&v.back(), &w.back(), sizeof(v.back())), 0) << of_a.name;
          },
          of_a.values);
    }
  }
  for (const auto* name : {"simultaneous_collisions", "order_lost"})
    EXPECT_EQ(tools::attribute<std::uint64_t>(a.attributes, name, ""),
              tools::attribute<std::uint64_t>(b.attributes, name, ""));
}

TEST_F(Run, EventsAreEveryCollisionInOrder) {
  ASSERT_EQ(shell("cradle run collapse3 --quiet").status, 3);
  const auto result = read_result((folder / "collapse3.h5").string());
  const auto* events = result.find("events");
  ASSERT_NE(events, nullptr);
  std::size_t count = 0;
  for (const auto& column : events->columns) {
    count = column.rows();
    if (column.name != "interval") continue;
    const auto& intervals = std::get<std::vector<double>>(column.values);
    // Closed form: intervals shrink by lam-/lam+ = 5/16 per collision, resolved down to 1e-160.
    for (std::size_t n = 20; n < intervals.size(); ++n) EXPECT_NEAR(intervals[n] / intervals[n - 1], 0.3125, 1e-6) << n;
    EXPECT_LT(intervals.back(), 1e-160);
  }
  EXPECT_EQ(count, 322U);
}

// What nothing measures is not written: not as 0 either.
TEST_F(Run, ClosureErrorsAreWrittenWhereTheyAreMeasured) {
  const auto written = [&](const std::string& law, const std::string& more, const char* name) {
    write("s.toml", "[law]\n" + law + "\n[initial]\ntype = \"rows\"\nparticles = 2000\nperturbation = 0.05\n[run]\n" +
                        more + "until = 500\n[output]\nsnapshots = [300]\n");
    EXPECT_EQ(shell("cradle run s.toml --quiet -o s.h5").status, 0) << law;
    std::optional<double> found;
    const auto result = read_result((folder / "s.h5").string());
    for (const auto& [key, value] : result.find("snapshots/0000")->attributes)
      if (key == name) found = std::get<double>(value);
    return found;
  };
  const std::string dry = "type = \"inelastic\"\nrestitution = 0.999\ncutoff = 1e-5",
                    wet = "type = \"wet\"\nloss = 0.05";
  EXPECT_NE(written(dry, "", "closure_gap").value_or(0), 0);
  EXPECT_TRUE(written(dry, "", "closure_speed"));
  EXPECT_NE(written(wet, "", "closure_gap").value_or(0), 0);
  EXPECT_FALSE(written(wet, "", "closure_speed"));
  for (const char* name : {"closure_gap", "closure_speed"}) {
    EXPECT_FALSE(written("type = \"sticky\"", "", name)) << name;
    EXPECT_FALSE(written(dry, "coordinates = \"absolute\"\n", name)) << name;
  }
}

// The energy that a collapse leaves is that of the proof, in any type.
TEST_F(Run, EnergyAtACollapseHasDigits) {
  const auto last = [&](const std::string& file) {
    const auto result = read_result((folder / file).string());
    return std::get<std::vector<double>>(result.find("series")->columns[1].values).back();
  };
  const std::string run = "cradle run collapse3 --quiet --set output.events=false ";
  ASSERT_EQ(shell(run + "-o a.h5").status, 3);
  const double energy = last("a.h5");
  EXPECT_GT(energy, 1e-257);
  EXPECT_LT(energy, 1e-254);
  ASSERT_EQ(shell(run + "--set run.precision=double-double -o b.h5").status, 3);
  EXPECT_NEAR(last("b.h5") / energy, 1, 1e-13);
  const Printed proof = shell("cradle certify collapse3 --quiet -o c.h5");
  ASSERT_EQ(proof.status, 0) << proof.err;
  const auto proved = read_result((folder / "c.h5").string());
  bool found = false;
  for (const auto& group : proved.groups)
    for (const auto& column : group.columns)
      if (column.name == "energy_low" && std::holds_alternative<std::vector<double>>(column.values)) {
        EXPECT_NEAR(std::get<std::vector<double>>(column.values).back() / energy, 1, 1e-12);
        found = true;
      }
  EXPECT_TRUE(found);
  // Of the run's own: digits and the ledger's difference; and the last snapshot is at the collision, not at a rounded
  // time beside it.
  const auto result = read_result((folder / "a.h5").string());
  EXPECT_GT(tools::attribute<double>(result.attributes, "energy_digits", ""), 12);
  EXPECT_LT(tools::attribute<double>(result.attributes, "energy_digits", ""), 16);
  EXPECT_LT(std::abs(tools::attribute<double>(result.attributes, "ledger_error", "")), 1e-15);
  EXPECT_EQ(tools::attribute<double>(result.find("snapshots/0000")->attributes, "gap_min", ""), 0);
}

// Above the threshold of collapse, and of numbers that doubles do not add up to the momentum of: 0.3 - 0.1 - 0.2.
TEST_F(Run, EnergyIsNeverNegative) {
  for (const std::string set : {"law.restitution=0.072", "initial.v=[0.3,-0.1,-0.2] --set run.until=20"}) {
    const Printed run = shell("cradle run collapse3 --quiet --set output.events=false -o a.h5 --set " + set);
    ASSERT_EQ(run.status, set.front() == 'l' ? 0 : 3) << run.err;
    const auto result = read_result((folder / "a.h5").string());
    const auto& energy = std::get<std::vector<double>>(result.find("series")->columns[1].values);
    for (std::size_t k = 1; k < energy.size(); ++k) {
      EXPECT_GE(energy[k], 0) << set;
      EXPECT_LE(energy[k], energy[k - 1]) << set;
    }
    EXPECT_LT(energy.back(), set.front() == 'l' ? 1e-70 : 1e-250) << set;
  }
}

// No type shares more digits with another run than it has.
TEST_F(Run, TrustedDigitsAreThoseOfTheType) {
  ASSERT_EQ(shell("cradle trust fig6 --set initial.particles=2000 --set run.until=100 --digits 16,31,50").status, 0);
  const auto result = read_result((folder / "fig6-trust.h5").string());
  ASSERT_EQ(result.groups.size(), 3U);
  const double most[] = {16, 32, 50};
  for (std::size_t k = 0; k < 3; ++k)
    for (const auto& column : result.groups[k].columns)
      if (column.name != "time") {
        const auto& digits = std::get<std::vector<double>>(column.values);
        EXPECT_LE(*std::max_element(digits.begin(), digits.end()), most[k]) << column.name;
      }
}

}  // namespace run_test
}  // namespace cradle::tests
