// Gaps and closing speeds at the start are the exact differences of a scene's decimals, rounded once, however far from
// the origin the particles are: in every type, between particles and to walls. The collisions that follow are those of
// rationals.
#include <random>

#include "cradle/precision/scalars.hpp"
#include "cradle/tests/precision/reference_gas.hpp"
#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/initial_state.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::gaps_test {

using test::Rational;
using tests::refusal;

Rational exact(const std::string& text) { return test::decimal<Rational>(text); }
std::string list_of(const std::vector<std::string>& texts) { return fmt::format("[{}]", fmt::join(texts, ", ")); }

// A decimal of `digits` random digits times ten to a random power from `lowest` to `highest`, and a random sign.
std::string drawn(std::mt19937_64& random, int digits, int lowest, int highest, bool sign) {
  std::string text = sign && random() % 2 == 0 ? "-" : "";
  text += static_cast<char>('1' + random() % 9);
  text += '.';
  for (int i = 1; i < digits; ++i) text += static_cast<char>('0' + random() % 10);
  return text + "e" + std::to_string(lowest + static_cast<int>(random() % static_cast<unsigned>(highest - lowest + 1)));
}

// Particles at gaps of 1e-30 to 1, at places of up to 1e12.
struct Particles {
  std::vector<std::string> x, v;
  std::vector<Rational> gap, speed;  // of neighbours: exactly
};

std::string in_places(const Rational& number, int places) {
  using boost::multiprecision::cpp_int;
  const Rational scaled = number * Rational(pow(cpp_int(10), static_cast<unsigned>(places)));
  return cpp_int(numerator(scaled) / denominator(scaled)).str() + "e-" + std::to_string(places);
}

Particles draw(std::mt19937_64& random, int count) {
  Particles particles;
  Rational x = exact(drawn(random, 20, -2, 12, true));
  for (int i = 0; i < count; ++i) {
    particles.x.push_back(in_places(x, 50));
    particles.v.push_back(drawn(random, 18, -3, 0, true));
    x += exact(drawn(random, 18, -30, -1, false));
  }
  for (std::size_t i = 1; i < particles.x.size(); ++i) {
    particles.gap.push_back(exact(particles.x[i]) - exact(particles.x[i - 1]));
    particles.speed.push_back(exact(particles.v[i - 1]) - exact(particles.v[i]));
  }
  return particles;
}

std::string list_scene(const Particles& particles, const std::string& more) {
  return "law = { type = 'inelastic', restitution = 0.6 }\ninitial = { type = 'list', x = " + list_of(particles.x) +
         ", v = " + list_of(particles.v) + " }\n" + more;
}

// Within half a unit in the last place; in types with which rationals cannot be made, once more so much for the text of
// a number, which reads back as it.
template <class T> testing::AssertionResult rounded_once(const T& number, const Rational& wanted) {
  Rational value, bound = exact(to_text(T(std::numeric_limits<T>::epsilon()))) * abs(wanted);
  if constexpr (std::floating_point<T>)
    value = Rational(number), bound /= 2;
  else
    value = exact(to_text(number));
  const Rational off = abs(Rational(value - wanted));
  if (off <= bound) return testing::AssertionSuccess();
  return testing::AssertionFailure() << to_text(number) << " is off by " << static_cast<double>(off / abs(wanted));
}

template <class F> void in_every_type(const F& f) {
  constexpr std::pair<const char*, int> types[] = {{"double", 0},   {"long double", 0},   {"double-double", 0},
                                                   {"float128", 0}, {"cpp_bin_float", 0}, {"mpfr", 20},
                                                   {"mpfr", 50},    {"mpfr", 150},        {"mpfr", 1000}};
  for (const auto& [precision, digits] : types) {
    std::string run = fmt::format("[run]\nuntil = 1\nprecision = '{}'\n", precision);
    if (digits > 0) run += fmt::format("digits = {}\n", digits);
    try {
      with_scalar<void>({precision, static_cast<unsigned>(digits)}, [&](auto type) { f(type, run); });
    } catch (const std::invalid_argument& error) {
      EXPECT_TRUE(test::has(error.what(), "in this build"));
    }
  }
}

TEST(InitialGaps, OfListsAreDifferencesOfDecimalsInEveryType) {
  in_every_type([](auto type, const std::string& run) {
    using T = typename decltype(type)::type;
    std::mt19937_64 random(4100);
    for (int scene = 0; scene < 40; ++scene) {
      const Particles particles = draw(random, 6);
      const auto made = initial_particles<T>(parse_scene(list_scene(particles, run), "s.toml"));
      for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_TRUE(rounded_once(made->gap(static_cast<ParticleIndex>(i)), particles.gap[i])) << run;
        EXPECT_TRUE(rounded_once(made->closing_speed(static_cast<ParticleIndex>(i)), particles.speed[i])) << run;
      }
    }
  });
}

TEST(InitialGaps, ToWallsAndAcrossTheSeamOfRingsAreDifferencesOfDecimals) {
  in_every_type([](auto type, const std::string& run) {
    using T = typename decltype(type)::type;
    const auto expect = [&](ParticleIndex particle, const char* gap, const std::string& scene) {
      const std::string text = "law = { type = 'inelastic', restitution = 0.5 }\n" + scene + run;
      EXPECT_TRUE(rounded_once(initial_particles<T>(parse_scene(text, "s.toml"))->gap(particle), exact(gap))) << text;
    };
    const std::string list = "initial = { type = 'list', x = [1000000000.000001, 1000000007], v = [0, 0]",
                      walls = "walls = { left = { position = 1e9 }, right = { position = 1000000007.0000000003 } }\n";
    expect(-1, "1e-6", list + " }\n" + walls);
    expect(1, "3e-10", list + " }\n" + walls);
    expect(1, "1e-6", list + ", length = 7 }\n");
    // Rows: the outermost particles are 999.5 spacings of 0.1, and 499.5 of 1/3, from the origin.
    expect(-1, "3e-13",
           "initial = { type = 'rows', particles = 2000, spacing = 0.1 }\nwalls.left.position = -99.9500000000003\n");
    expect(
        504, "1e-17",
        "initial.left = { particles = 5, speed = 1, density = 7 }\ninitial.type = 'rows'\n"
        "initial.right = { particles = 500, speed = 0, density = 3 }\nwalls.right.position = 166.50000000000000001\n");
    // A cold gas begins at the hot particle; a gas has its first particle half a cell from its wall.
    expect(1000, "7e-13",
           "initial = { type = 'cold', particles = 1001, spacing = 0.1, place = 'left' }\n"
           "walls.right.position = 100.0000000000007\n");
    expect(-1, "1e-6",
           "initial = { type = 'gas', particles = 8 }\n"
           "walls = { left.position = 1e12, right.position = 1000000000000.000016 }\n");
  });
}

TEST(InitialGaps, AreThoseOfTheKey) {
  in_every_type([](auto type, const std::string& run) {
    using T = typename decltype(type)::type;
    const Scene scene = parse_scene("law.type = 'sticky'\ninitial = { type = 'list', gap = [0.1, 1e-30, 1e-200], x = "
                                    "[1e9], v = [1, 0, 0, 0], length = 1 }\n" +
                                        run,
                                    "s.toml");
    const auto made = initial_particles<T>(scene);
    EXPECT_TRUE(rounded_once(made->gap(0), exact("0.1")));
    EXPECT_TRUE(rounded_once(made->gap(1), exact("1e-30")));
    EXPECT_TRUE(rounded_once(made->gap(2), exact("1e-200")));
    EXPECT_TRUE(rounded_once(made->gap(3), Rational(exact("0.9") - exact("1e-30") - exact("1e-200"))));
    EXPECT_TRUE(rounded_once(made->position(1), exact("1000000000.1")));
    EXPECT_TRUE(parse_scene(effective_toml(scene), "s.toml") == scene);
  });
}

RunOutcome run_of(const std::string& scene) {
  return run_scene(parse_scene(scene, "s.toml"), {.progress = Progress::Show::never});
}

using Collisions = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // the particles on the left and on the right

Collisions collisions_of(const Result& run) {
  Collisions pairs;
  const auto left = tests::numbers<std::uint64_t>(run, "events", "left"),
             right = tests::numbers<std::uint64_t>(run, "events", "right");
  for (std::size_t k = 0; k < left.size(); ++k) pairs.emplace_back(left[k], right[k]);
  return pairs;
}

// Six particles of this restitution do not collapse: tan^2(pi/6) = 1/3.
TEST(InitialGaps, OrderOfCollisionsIsThatOfRationals) {
  std::mt19937_64 random(4101);
  for (int scene = 0; scene < 2000; ++scene) {
    const Particles particles = draw(random, 3 + static_cast<int>(random() % 4));
    test::Gas<Rational> gas;
    gas.restitution = Rational(6, 10);
    for (std::size_t i = 0; i < particles.x.size(); ++i)
      gas.cells.push_back({exact(particles.x[i]), exact(particles.v[i]), 1, {static_cast<std::int64_t>(i)}});
    Collisions collisions;
    while (const auto pair = gas.next(1)) collisions.push_back(*pair);
    const auto energy = static_cast<double>(gas.energy());
    const std::string text = list_scene(particles, "run.until = 1\noutput = { events = true, series.points = 2 }\n");
    const RunOutcome outcome = run_of(text);
    for (const char* uncertain : {"simultaneous_collisions", "order_lost"})
      EXPECT_EQ(attribute<std::uint64_t>(outcome.result.attributes, uncertain, ""), 0U) << text;
    ASSERT_EQ(collisions_of(outcome.result), collisions) << scene << '\n' << text;
    EXPECT_NEAR(outcome.energy, energy, 1e-12 * energy) << text;
  }
}

const std::string touching = "law = { type = 'inelastic', restitution = 1 }\ninitial.type = 'list'\nrun.until = 5\n";

TEST(TouchingParticles, ThatPartOrRestAreAccepted) {
  EXPECT_EQ(run_of(touching + "initial.x = [0, 1, 1]\ninitial.v = [1, 0, 2]").energy, 2.5);
  EXPECT_EQ(run_of(touching + "initial.gap = [1, 0]\ninitial.v = [-1, 0, 0]").energy, 0.5);
}

// As is advised where they touch and approach (tests/tools/messages.txt).
TEST(TouchingParticles, AreGivenADistanceInstead) {
  for (const char* gaps : {"[1, 1e-300]", "[1e-300, 1e-300]"}) {
    const RunOutcome cradle = run_of(touching + "initial.gap = " + gaps + "\ninitial.v = [1, 0, 0]");
    EXPECT_EQ(cradle.collisions, 2U);
    EXPECT_EQ(cradle.warning, "");
  }
}

// A run that is continued from files of its last state: gaps and closing speeds are read, not differences of positions,
// which do not resolve a collapse.
class Continued : public tests::ProgramTest {
 protected:
  Collisions collisions(const std::string& common, const std::string& initial, const std::string& start,
                        const std::string& until, const std::string& result) {
    write("scene.toml",
          fmt::format(
              "{}run.start = {}\nrun.until = {}\noutput = {{ events = true, series.points = 2, snapshots = [{}] }}"
              "\n[initial]\n{}",
              common, start, until, until, initial));
    shell("cradle run scene.toml --quiet -o " + result, 0);
    return collisions_of(read(result));
  }

  // The columns at the end differ by `bound(x, roundings)` at most, of a number x and what all collisions have rounded.
  template <class Bound>
  void has_the_collisions_of_one_run(const std::string& common, const std::string& initial,
                                     const std::vector<std::string>& times, const std::vector<std::string>& columns,
                                     const Bound& bound) {
    const Collisions whole = collisions(common, initial, "0", times.back(), "whole.h5");
    Collisions pieces;
    std::string start = "0", from = initial;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::string result = fmt::format("{}.h5", k);
      const Collisions piece = collisions(common, from, start, times[k], result);
      pieces.insert(pieces.end(), piece.begin(), piece.end());
      start = times[k], from = "type = 'list'\nfile = '" + result + "'\n";
    }
    EXPECT_EQ(pieces, whole);
    EXPECT_GT(whole.size(), times.size());
    for (const std::string& column : columns) {
      const auto at_end = tests::numbers(read("whole.h5"), "snapshots/0000", column),
                 in_pieces = tests::numbers(read(fmt::format("{}.h5", times.size() - 1)), "snapshots/0000", column);
      ASSERT_EQ(at_end.size(), in_pieces.size());
      const double eps = std::numeric_limits<double>::epsilon(),
                   roundings = 8 * eps * static_cast<double>(whole.size() + at_end.size() + 64);
      for (std::size_t i = 0; i < at_end.size(); ++i)
        if (!std::isnan(at_end[i])) {
          EXPECT_NEAR(in_pieces[i], at_end[i], bound(at_end[i], roundings)) << column << ' ' << i;
        }
    }
  }
};

// r = 0.05: the collapse is at 12/7 = 1.714285714...; a gap shrinks by 1/8 from one collision to the next. Each
// rounding moves the collapse by some units of the last place, and all gaps are shorter by that.
TEST_F(Continued, CollapseHasTheCollisionsOfOneRun) {
  const std::vector<std::string> times = {
      "1",         "1.5",         "1.7",           "1.714",           "1.71428",
      "1.7142857", "1.714285714", "1.71428571428", "1.7142857142857", "1.714285714285713"};
  const double collapse = 12. / 7, end = std::stod(times.back());
  has_the_collisions_of_one_run(
      "law = { type = 'inelastic', restitution = 0.05 }\n", "type = 'list'\nx = [0, 1, 3]\nv = [1, 0, -1]\n", times,
      {"gap"}, [=](double gap, double roundings) { return roundings * collapse / (collapse - end) * gap; });
}

// The bound is that of tools/proof/agreement.hpp, with speeds of at most 2 and a length of 5.
TEST_F(Continued, RingHasTheCollisionsOfOneRun) {
  std::vector<std::string> times;
  for (int k = 1; k <= 10; ++k) times.push_back(fmt::format("{}", 12 * k));
  has_the_collisions_of_one_run(
      "law = { type = 'inelastic', restitution = 0.9 }\n",
      "type = 'list'\nx = [0, 0.9, 2.3, 3.1, 4.4]\nv = [1, -0.3, 0.8, -1.7, 0.2]\nlength = 5\n", times, {"gap"},
      [](double, double roundings) { return roundings * (5 + 2 * 120); });
}

// Positions up to 60 are rounded where one run ends, and at each of some hundred collisions after that.
TEST_F(Continued, RandomStatesHaveTheCollisionsOfOneRun) {
  const std::string law = "law = { type = 'inelastic', restitution = 0.95, cutoff = 1e-3 }\n";
  for (const bool wide : {false, true})
    for (const auto& [walls, initial] : {std::pair("walls = { left.position = 0, right.position = 60 }\n",
                                                   "type = 'gas'\nparticles = 60\npositions = 'poisson'\n"),
                                         {"", "type = 'ring'\nparticles = 50\nmasses = [1, 2]\n"}}) {
      shell("rm -f *.h5", 0);
      has_the_collisions_of_one_run(law + (wide ? "run.precision = 'double-double'\n" : "") + walls, initial,
                                    {"4", "8"}, {"x", "v", "m"}, [=](double, double) { return wide ? 1e-14 : 1e-11; });
    }
}

}  // namespace cradle::tools::gaps_test
