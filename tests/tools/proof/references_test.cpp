// Every number of a certificate against an independent gas (reference_gas.hpp), on scenes drawn at random: lists of two
// to nine particles (separate groups, lattices, central masses, a few that move), rows, cold gases, rings, walls,
// gravity and replicas, every law that can be proved, ends and samples with more digits than a double has. The numbers
// of an undecided certificate are checked up to the time at which it is undecided. Proofs of replicas have the
// statistics of their ensemble. (Single runs, threads, and where proofs end: tests/tools/outputs.txt. What is refused:
// tests/tools/messages.txt.)
#include <iostream>
#include <random>

#include <fmt/ranges.h>

#include "cradle/core/initial/gas.hpp"
#include "cradle/tests/precision/reference_gas.hpp"
#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/proof/certify.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tests::references_test {

using namespace cradle::tools;
using test::decimal;
using test::Gas;
using test::GasLaw;
using test::Rational;

using Random = std::mt19937_64;

constexpr std::uint64_t most_collisions = 120;  // of scenes that are compared: rationals grow

std::int64_t below(Random& random, std::int64_t bound) {
  return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(bound));
}
template <class Item> Item one_of(Random& random, std::initializer_list<Item> items) {
  return items.begin()[below(random, static_cast<std::int64_t>(items.size()))];
}
// A decimal of n / 10^places and, now and then, of some twenty more digits.
std::string number_of(Random& random, std::int64_t n, int places) {
  const bool negative = n < 0;
  std::string digits = std::to_string(negative ? -n : n);
  if (digits.size() <= static_cast<std::size_t>(places))
    digits.insert(0, static_cast<std::size_t>(places) + 1 - digits.size(), '0');
  digits.insert(digits.size() - static_cast<std::size_t>(places), ".");
  if (below(random, 6) == 0)
    for (int k = 0; k < 20; ++k) digits += static_cast<char>('0' + below(random, 10));
  if (digits.ends_with('.')) digits += '0';
  return (negative ? "-" : "") + digits;
}

struct LawText {
  std::string law, run;
  bool roots = false;
};
// Of particles that bounce, if there are walls.
LawText draw_law(Random& random, bool walls = false) {
  const std::int64_t kind = walls ? one_of(random, {2, 4, 5, 6, 7, 8, 9}) : below(random, 8);
  if (kind == 0) return {"law = {type = \"sticky\"}\n", ""};
  if (kind == 1)
    return {fmt::format("law = {{type = \"wet\", loss = {}}}\n", one_of(random, {"0.01", "0.1", "0.5", "2"})), "",
            true};
  const std::string law =
      fmt::format("law = {{type = \"inelastic\", restitution = {}",
                  one_of(random, {"1", "0.999", "0.9", "0.5", "0.3", "0.07", "0.01", "0.99999999999999999999"}));
  if (kind == 2)
    return {law + "}\n", fmt::format("run.collapse = \"contact-time\"\nrun.contact_time = {}\n",
                                     one_of(random, {"0.1", "0.01", "0.5"}))};
  if (kind == 3)
    return {law + "}\n",
            fmt::format("run.collapse = \"merge\"\nrun.merge_speed = {}\n", one_of(random, {"0.2", "0.05", "1"}))};
  if (kind == 4) return {law + "}\n", "run.collapse = \"stop\"\n"};
  const std::string cutoff = fmt::format(", cutoff = {}", one_of(random, {"0.1", "0.01", "0.5", "1"}));
  if (kind < 8) return {law + cutoff + "}\n", ""};
  return {law + cutoff + fmt::format(", cutoff_exponent = {}}}\n", one_of(random, {"1", "4", "0.5", "2.5", "\"3.0\""})),
          "", true};
}
// A scene with its particles.
struct Drawn {
  Scene scene;
  bool roots = false;  // not all of it is rational
};
Drawn with_law(const LawText& law, const std::string& state, const std::string& times, bool roots = false) {
  return {parse_scene(law.law + state + law.run + times, "drawn", {}), law.roots || roots};
}

// One wall or two beside particles from `first` to `last`; of two none moves inwards.
std::string draw_walls(Random& random, double first, double last) {
  const std::int64_t which = below(random, 3);
  std::string walls;
  for (const std::int64_t side : {0, 1}) {
    if (which == side) continue;
    const std::int64_t cents = 2 + below(random, 300), sign = side == 0 ? -1 : 1;
    const std::string name = side == 0 ? "walls.left." : "walls.right.";
    const auto outermost = static_cast<std::int64_t>(std::floor((side == 0 ? first : last) * 100));
    walls += name + "position = \"" + number_of(random, outermost + sign * cents, 2) + "\"\n";
    if (below(random, 2) == 0)
      walls += name + "speed = \"" +
               number_of(random, (which < 2 ? below(random, 120) - 60 : sign * below(random, 60)), 2) + "\"\n";
    if (which == 2 && below(random, 4) == 0) continue;
    if (below(random, 3) == 0)
      walls += name + fmt::format("temperature = {}\n", one_of(random, {"1", "0.3", "2.5"}));
    else
      walls += name + fmt::format("restitution = {}\n", one_of(random, {"1", "0.9", "0.35", "0.99999999999999999999"}));
  }
  return walls;
}

// Sampled at times of every kind.
std::string draw_times(Random& random) {
  const std::string until = number_of(random, 100 + below(random, 700), 2);
  const std::string times = "{times = [\"0.50000000000000000000000001\", 0.7, \"" + until + "\"]}";
  return fmt::format("run.until = \"{0}\"\noutput.series = {1}\n"
                     "output.snapshots = [0.3, \"0.7000000000000000000001\", \"{0}\"]\n",
                     until, one_of(random, {"{points = 4}", "{every = 0.3}", times.c_str()}));
}

// Places increase by random gaps; the kind of list decides which particles move, and the masses.
std::string draw_particles(Random& random) {
  enum Kind { any, groups, lattice, central, few_move };
  const Kind kind = one_of(random, {any, any, groups, groups, lattice, central, few_move});
  const std::int64_t particles = 2 + below(random, 8);
  const bool masses = kind == central || below(random, 2) == 0;
  std::int64_t place = -below(random, 500);
  std::vector<std::string> x, v, m;
  for (std::int64_t b = 0; b < particles; ++b) {
    const bool moves = kind != few_move || below(random, 3) == 0;
    // Digits beyond a double's must not change the order.
    x.push_back(kind == lattice ? std::to_string(b) : number_of(random, place, 2));
    v.push_back(kind == lattice ? std::to_string(below(random, 5) - 2)
                : moves         ? number_of(random, below(random, 400) - 200, 2)
                                : "0");
    if (masses)
      m.push_back(kind == central && b == particles / 2 ? one_of(random, {"1000", "0.001", "30.5"})
                  : kind == central                     ? "1"
                                                        : number_of(random, 20 + below(random, 300), 2));
    place += kind == groups && below(random, 3) == 0 ? 2000 + below(random, 500) : 2 + below(random, 200);
  }
  std::string list = "initial.type = \"list\"\n";
  for (const auto& [name, numbers] : {std::pair("x", &x), std::pair("v", &v), std::pair("m", &m)})
    if (!numbers->empty()) list += fmt::format("initial.{} = [\"{}\"]\n", name, fmt::join(*numbers, "\", \""));
  return list;
}

Drawn draw_list(Random& random) {
  const LawText law = draw_law(random);
  const std::string times = draw_times(random);
  return with_law(law, draw_particles(random), times);
}
Drawn draw_walled(Random& random) {
  const LawText law = draw_law(random, true);
  const std::string list = draw_particles(random);
  const Initial bare = parse_scene("law.type = \"sticky\"\nrun.until = 1\n" + list, "bare", {}).initial;
  const std::string walls = draw_walls(random, Decimal(bare.x[0]).value, Decimal(bare.x.back()).value);
  return with_law(law, list + walls, draw_times(random));
}
// Under gravity; on an inelastic floor particles collapse, so laws without a threshold are left out.
Drawn draw_falling(Random& random) {
  Drawn d = draw_walled(random);
  while (d.scene.law.cutoff == Decimal("0") && d.scene.run.collapse != tools::scene::CollapsePolicy::contact_time)
    d = draw_walled(random);
  d.scene.gravity.acceleration =
      Decimal(number_of(random, below(random, 2) == 0 ? 1 + below(random, 200) : -1 - below(random, 200), 2));
  d.roots = true;
  return d;
}
std::string draw_masses(Random& random) {
  return one_of(random, {"", "", ", masses = [0.5]", ", masses = [\"0.1\", \"0.10\"]", ", masses = [0.3, 2]",
                         ", masses = [1, \"1.00000000000000000000001\"]"});
}
Drawn draw_ring(Random& random) {
  const LawText law = draw_law(random);
  const std::string initial = "initial = {type = \"ring\", particles = " + std::to_string(2 + 2 * below(random, 4)) +
                              ", length = " + one_of(random, {"5", "7.3", "20"}) + ", velocities = \"" +
                              one_of(random, {"gaussian", "uniform"}) +
                              "\", variance = " + one_of(random, {"1", "0.25", "2.25"}) +
                              ", perturbation = " + one_of(random, {"0", "0.1", "0.3"}) + draw_masses(random) +
                              ", seed = " + std::to_string(below(random, 1000000)) + "}\n";
  return with_law(law, initial, draw_times(random));
}
Drawn draw_cold(Random& random) {
  const LawText law = draw_law(random);
  const std::int64_t hot = one_of(random, {1, 1, 2, 3});
  const std::string initial = "initial = {type = \"cold\", particles = " + std::to_string(4 + below(random, 6)) +
                              ", hot = " + std::to_string(hot) + (hot == 1 ? ", speed = 1.5" : ", energy = 2") +
                              ", place = \"" + one_of(random, {"left", "middle"}) +
                              "\", spacing = " + one_of(random, {"1", "0.3"}) +
                              ", perturbation = " + one_of(random, {"0", "0.3"}) + draw_masses(random) +
                              ", seed = " + std::to_string(below(random, 1000000)) + "}\n";
  return with_law(law, initial, draw_times(random), hot > 1);
}
Drawn draw_rows(Random& random) {
  const LawText law = draw_law(random);
  const auto row = [&](const char* speed) {
    return "{particles = " + std::to_string(1 + below(random, 4)) + ", speed = " + speed +
           ", density = " + one_of(random, {"1", "2.5", "0.7"}) + "}";
  };
  const std::string initial = "initial = {type = \"rows\", left = " + row("1") + ", right = " + row("-0.5") +
                              one_of(random, {std::string(), std::string(", centre = {mass = 3, speed = 0.1}"),
                                              std::string(", centre = {mass = 1e-3, speed = 0}")}) +
                              ", perturbation = " + one_of(random, {"0", "0.3"}) +
                              ", seed = " + std::to_string(below(random, 1000000)) + "}\n";
  return with_law(law, initial, draw_times(random));
}

// ---- the same scene as a gas

template <class T> T of(const Decimal& number) { return decimal<T>(number.text); }

template <class T> T mass_of(const Initial& initial, std::int64_t particle) {
  if (initial.masses.empty()) return T(1);
  return of<T>(initial.masses[static_cast<std::size_t>(particle) % initial.masses.size()]);
}

template <class T> void put(Gas<T>& gas, T x, T v, T m) {
  gas.cells.push_back({std::move(x), std::move(v), std::move(m), {static_cast<std::int64_t>(gas.cells.size())}});
}

// Places in spacings, from where the first one would stand: (b + offset + a whole number of 2^-28).
template <class T> T displaced(const Initial& initial, std::int64_t particle, const T& offset) {
  const auto moved = uniform_displacement(initial.perturbation.value, initial.seed, initial.replica)(particle);
  return T(particle) + offset + T(moved) / T(displacement_unit);
}

template <class T> T root(const T& x) {
  if constexpr (std::is_same_v<T, Rational>) {
    const auto of_integer = [](const auto& n) {
      const Rational r(sqrt(boost::multiprecision::cpp_int(n)));
      EXPECT_TRUE(r * r == Rational(n));
      return r;
    };
    return of_integer(numerator(x)) / of_integer(denominator(x));
  } else {
    return sqrt(x);
  }
}

template <class T> void put_ring(const Initial& initial, Gas<T>& gas) {
  const auto particles = static_cast<std::int64_t>(initial.particles);
  gas.length = of<T>(initial.length);
  const auto paces = drawn(initial.velocities == Velocities::gaussian ? gaussian_velocity(initial.seed, initial.replica)
                                                                      : uniform_velocity(initial.seed, initial.replica),
                           0, particles);
  const auto draw = [&](std::int64_t b) { return paces[static_cast<std::size_t>(b)]; };
  bool identical = true;
  std::int64_t sum = 0;
  T momentum(0), mass(0);
  for (std::int64_t b = 0; b < particles; ++b) {
    identical = identical && mass_of<T>(initial, b) == mass_of<T>(initial, 0);
    sum += draw(b), momentum += mass_of<T>(initial, b) * T(draw(b)), mass += mass_of<T>(initial, b);
  }
  const auto mean = static_cast<std::int64_t>(std::floor(static_cast<double>(sum) / static_cast<double>(particles)));
  for (std::int64_t b = 0; b < particles; ++b) {
    const T pace =
        identical ? T(draw(b) - mean - (b < sum - mean * particles ? 1 : 0)) : T(T(draw(b)) - momentum / mass);
    put<T>(gas, displaced<T>(initial, b, T(1) / T(2)) * gas.length / T(particles),
           pace * root<T>(of<T>(initial.variance)) / T(displacement_unit), mass_of<T>(initial, b));
  }
}

template <class T> void put_cold(const Initial& initial, Gas<T>& gas) {
  const auto particles = static_cast<std::int64_t>(initial.particles), hot = static_cast<std::int64_t>(initial.hot);
  const std::int64_t first = initial.place == tools::scene::HotPlace::left ? 0 : (particles - hot) / 2;
  const auto paces = drawn(gaussian_velocity(initial.seed, initial.replica), first, hot);
  const auto draw = [&](std::int64_t b) { return paces[static_cast<std::size_t>(b - first)]; };
  T momentum(0), mass(0), twice(0);
  for (std::int64_t b = first; b < first + hot; ++b)
    momentum += mass_of<T>(initial, b) * T(draw(b)), mass += mass_of<T>(initial, b);
  const auto pace = [&](std::int64_t b) { return T(T(draw(b)) - momentum / mass); };
  for (std::int64_t b = first; b < first + hot; ++b) twice += mass_of<T>(initial, b) * pace(b) * pace(b);
  const T middle = initial.place == tools::scene::HotPlace::left ? T(0) : T(T(1 - hot - 2 * first) / T(2));
  for (std::int64_t b = 0; b < particles; ++b) {
    T v(0);
    if (b >= first && b < first + hot)
      v = hot == 1 ? of<T>(initial.speed) : T(pace(b) * root<T>(T(2 * of<T>(initial.energy) / twice)));
    put<T>(gas, displaced<T>(initial, b, middle) * of<T>(initial.spacing), v, mass_of<T>(initial, b));
  }
}

template <class T> void put_rows(const Initial& initial, Gas<T>& gas) {
  const auto left = static_cast<std::int64_t>(initial.left.particles),
             right = static_cast<std::int64_t>(initial.right.particles);
  for (std::int64_t b = 0; b < left; ++b)
    put<T>(gas, displaced<T>(initial, b, T(1) / T(2) - T(left)) / of<T>(initial.left.density),
           of<T>(initial.left.speed), T(1));
  const std::int64_t centre = initial.centre.mass == Decimal("0") ? 0 : 1;
  if (centre > 0) put<T>(gas, T(0), of<T>(initial.centre.speed), of<T>(initial.centre.mass));
  for (std::int64_t b = left + centre; b < left + centre + right; ++b)
    put<T>(gas, displaced<T>(initial, b, T(1) / T(2) - T(left + centre)) / of<T>(initial.right.density),
           of<T>(initial.right.speed), T(1));
}

template <class T> void put_wall(End end, const Scene& scene, Gas<T>& gas) {
  const WallAt& wall = end == End::left ? scene.walls.left : scene.walls.right;
  if (!wall.position) return;
  auto& put = gas.walls[static_cast<std::size_t>(end)];
  put = {of<T>(*wall.position), of<T>(wall.speed), wall.temperature ? T(1) : of<T>(wall.restitution)};
  if (wall.temperature)
    put->random_speed = [end, temperature = wall.temperature->value, &initial = scene.initial](std::uint64_t collision,
                                                                                               const T& mass) {
      return T(thermal_speed(initial.seed, initial.replica, end, collision) *
               std::sqrt(temperature / static_cast<double>(mass)));
    };
}

template <class T> Gas<T> gas_of(const Scene& scene) {
  Gas<T> gas;
  const auto& law = scene.law;
  gas.law = law.type == LawType::wet                                           ? GasLaw::wet
            : law.type == LawType::sticky                                      ? GasLaw::sticky
            : scene.run.collapse == tools::scene::CollapsePolicy::merge        ? GasLaw::merging
            : scene.run.collapse == tools::scene::CollapsePolicy::contact_time ? GasLaw::contact_time
                                                                               : GasLaw::inelastic;
  gas.restitution = of<T>(law.restitution), gas.cutoff = of<T>(law.cutoff), gas.loss = of<T>(law.loss);
  gas.contact_time = of<T>(scene.run.contact_time), gas.merge_speed = of<T>(scene.run.merge_speed);
  if (law.cutoff_exponent) gas.cutoff_exponent = of<T>(*law.cutoff_exponent);
  const Initial& initial = scene.initial;
  for (const End end : {End::left, End::right}) put_wall(end, scene, gas);
  if (scene.gravity.acts()) gas.acceleration = of<T>(*scene.gravity.acceleration);
  if (initial.type == InitialType::ring) put_ring(initial, gas);
  if (initial.type == InitialType::cold) put_cold(initial, gas);
  if (initial.type == InitialType::rows) put_rows(initial, gas);
  if (initial.type == InitialType::list)
    for (std::size_t b = 0; b < initial.x.size(); ++b)
      put<T>(gas, decimal<T>(std::string(initial.x[b])), decimal<T>(std::string(initial.v[b])),
             initial.m.empty() ? T(1) : decimal<T>(std::string(initial.m[b])));
  return gas;
}

// ---- the numbers of a certificate, against the gas

struct Tally {
  std::uint64_t scenes = 0, proved = 0, undecided = 0, refused = 0, left_out = 0, collisions = 0, numbers = 0;
};

template <class Values> const Values& values_of(const Group& group, std::string_view name) {
  return std::get<Values>(column(group, std::string(name)).values);
}
using Doubles = std::vector<double>;
using Texts = std::vector<std::string>;
using Whole = std::vector<std::uint64_t>;

template <class T> struct Comparison {
  const Scene& scene;
  bool roots;
  const Certificate& certificate;
  const Result& result;
  bool ends_at_collision;
  Tally& tally;

  void operator()() {
    EXPECT_TRUE(compare_samples() && compare_series() && compare_snapshots()) << "proved, but three met before";
  }

  // Advances to a sample; false where three met before, where every proof must end.
  bool reach(Gas<T>& gas, const std::string& time, bool at_collision, std::uint64_t collisions) {
    const std::uint64_t most = at_collision ? collisions : std::numeric_limits<std::uint64_t>::max();
    gas.advance(at_collision ? T(gas.time + T(1000000)) : decimal<T>(time), most);
    EXPECT_FALSE(gas.tied) << "proved beyond " << time;
    return !gas.tied;
  }
  bool compare_samples() {
    Gas<T> gas = gas_of<T>(scene);
    for (const CertainSample& s : certificate.samples) {
      const bool at_collision = ends_at_collision && &s == &certificate.samples.back();
      if (!reach(gas, s.time_text, at_collision, s.collisions)) return false;
      EXPECT_EQ(s.collisions, gas.collisions) << s.time_text;
      within("energy", s.energy, gas.energy());
      front(s.front_left, gas, gas.outermost(true));
      front(s.front_right, gas, gas.outermost(false));
      for (std::size_t side = 0; side < 2; ++side) {
        EXPECT_EQ(s.walls[side].has_value(), gas.walls[side].has_value());
        if (!s.walls[side]) continue;
        EXPECT_EQ(s.walls[side]->collisions, gas.walls[side]->collisions);
        within("energy given by a wall", s.walls[side]->given, gas.walls[side]->given);
        within("energy lost in a wall", s.walls[side]->lost, gas.walls[side]->lost);
      }
      if (held_whole()) margins(s, gas, at_collision);
    }
    return true;
  }
  // The tables have the same numbers, row by row, and the run's own counts beside them.
  bool compare_series() {
    const Group* series = result.find("series");
    const Group* bounds = result.find("certificate/series");
    const bool joined = bounds == nullptr;
    if (joined) bounds = series;
    const Group& exact = *result.find("exact/series");
    const auto& times = values_of<Texts>(exact, "time");
    EXPECT_EQ(bounds->columns.front().rows(), times.size());
    Gas<T> gas = gas_of<T>(scene);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const bool at_collision = ends_at_collision && k + 1 == times.size();
      if (!reach(gas, times[k], at_collision, certificate.collisions)) return false;
      row(*bounds, exact, k, "energy", gas.energy());
      for (const char* side : {"front_left", "front_right"}) {
        const auto* cell = gas.outermost(side == std::string("front_left"));
        if (cell != nullptr)
          row(*bounds, exact, k, side, gas.place(*cell));
        else
          EXPECT_EQ(values_of<Texts>(exact, std::string(side) + "_low")[k], "nan");
      }
      for (std::size_t side = 0; side < 2; ++side) {
        const std::string wall = side == 0 ? "wall_left" : "wall_right";
        if (!gas.walls[side]) continue;
        row(*bounds, exact, k, wall + "_energy", gas.walls[side]->given);
        if ((side == 0 ? scene.walls.left : scene.walls.right).dissipates())
          row(*bounds, exact, k, wall + "_lost", gas.walls[side]->lost);
      }
      if (!joined || series->columns[1].name != "energy") continue;  // bounds alone, where the run did not end
      EXPECT_EQ(values_of<Whole>(*series, "collisions")[k], gas.collisions);
      EXPECT_EQ(values_of<Whole>(*series, "merges")[k], gas.merges);
      if (scene.law.restitution != Decimal("1") || scene.law.type != LawType::inelastic) {
        EXPECT_EQ(values_of<Whole>(*series, "collisions_below_cutoff")[k], gas.below_cutoff);
      }
    }
    return true;
  }
  bool compare_snapshots() {
    for (std::size_t n = 0; n < scene.output.snapshots.size(); ++n) {
      const std::string name = "snapshots/000" + std::to_string(n);
      const Group *doubles = result.find("certificate/" + name), *exact = result.find("exact/" + name);
      if (doubles == nullptr || exact == nullptr) continue;
      EXPECT_EQ(std::get<double>(doubles->attributes.front().second), scene.output.snapshots[n].value);
      Gas<T> gas = gas_of<T>(scene);
      if (!reach(gas, scene.output.snapshots[n].text, false, 0)) return false;
      const auto& index = values_of<Whole>(*doubles, "index");
      EXPECT_EQ(index, values_of<Whole>(*exact, "index"));
      if (held_whole()) {
        EXPECT_EQ(index.size(), gas.cells.size());
      }
      for (std::size_t k = 0; k < index.size(); ++k) {
        const auto& cell = gas.cell_of(static_cast<std::int64_t>(index[k]));
        row(*doubles, *exact, k, "v", gas.velocity(cell));
        row(*doubles, *exact, k, "x", image(gas.place(cell), values_of<Doubles>(*doubles, "x_low")[k]));
      }
    }
    return true;
  }
  T image(const T& x, double near) const {
    if (scene.initial.type != InitialType::ring) return x;
    const T length = of<T>(scene.initial.length);
    const double turns = std::round((near - static_cast<double>(x)) / static_cast<double>(length));
    return x + T(static_cast<std::int64_t>(turns)) * length;
  }

  // Particles that no collision has reached are in no certificate.
  bool held_whole() const { return scene.initial.type == InitialType::ring || scene.initial.type == InitialType::list; }
  // The error of the reference itself.
  T slack(const T& x) const {
    if (!roots) return T(0);
    const T size = x < 0 ? T(-x) : x;
    return (size + 1) * decimal<T>("1e-70");
  }
  void between(const std::string& what, const T& low, const T& x, const T& high) {
    ++tally.numbers;
    EXPECT_TRUE(low <= x + slack(x) && x - slack(x) <= high)
        << what << " " << static_cast<double>(x) << " is not from " << static_cast<double>(low) << " to "
        << static_cast<double>(high) << ", above the ends by " << static_cast<double>(T(x - low)) << " and "
        << static_cast<double>(T(x - high));
  }
  void within(const std::string& what, const Enclosed& bounds, const T& x) {
    if (std::isfinite(bounds.doubles.low)) between(what, T(bounds.doubles.low), x, T(bounds.doubles.high));
    if (bounds.decimals.low != "-inf")
      between(what, decimal<T>(bounds.decimals.low), x, decimal<T>(bounds.decimals.high));
  }
  void front(const std::optional<Enclosed>& bounds, const Gas<T>& gas, const typename Gas<T>::Cell* cell) {
    ASSERT_EQ(bounds.has_value(), cell != nullptr);
    if (cell != nullptr) within("front", *bounds, gas.place(*cell));
  }
  void row(const Group& doubles, const Group& exact, std::size_t k, const std::string& name, const T& x) {
    const double low = values_of<Doubles>(doubles, name + "_low")[k],
                 high = values_of<Doubles>(doubles, name + "_high")[k];
    const std::string &from = values_of<Texts>(exact, name + "_low")[k],
                      to = values_of<Texts>(exact, name + "_high")[k];
    within(doubles.name + "/" + name, {{from, to}, {low, high}, 0}, x);
  }
  // Powers of ten: the least gap, and how wide places are.
  void margins(const CertainSample& s, const Gas<T>& gas, bool at_collision) {
    std::vector<T> gaps;
    for (std::size_t k = 0; k < gas.pairs(); ++k) gaps.push_back(gas.gap_after(k));
    for (const bool left : {true, false})
      if (gas.walls[left ? 0 : 1]) gaps.push_back(gas.gap_to_wall(left));
    std::optional<double> least;
    for (const T& size : gaps) {
      const double gap = std::log10(static_cast<double>(size));
      if (at_collision && gap < -100) continue;  // of those that meet
      if (!least || gap < *least) least = gap;
    }
    if (least && std::isfinite(s.least_gap) && !at_collision && s.widest_of_gap < -8) {
      EXPECT_NEAR(s.least_gap, *least, 1e-6);
    }
    EXPECT_NE(s.energy.decimals.low, "-inf");
    EXPECT_EQ(std::isfinite(s.least_gap), gaps.size() > (at_collision ? 1U : 0U)) << s.least_gap;
  }
};

void compare(const Drawn& drawn, Tally& tally) {
  ++tally.scenes;
  CertifyOptions how{.progress = Progress::Show::never};
  // The reference of scenes with roots has 100 digits.
  std::erase_if(how.digits, [&](unsigned digits) { return digits > (drawn.roots ? 50U : 100U); });
  try {
    Certified run = certify(drawn.scene, how);
    tally.proved += run.proved(), tally.undecided += !run.proved(), tally.collisions += run.certificate.collisions;
    if (run.certificate.collisions > most_collisions) {
      ++tally.left_out;
      return;
    }
    const bool at_collision =
        !run.certificate.doubt && run.outcome.end != RunEnd::reached && run.outcome.end != RunEnd::order_lost;
    const Certificate certificate = run.certificate;
    const Result result = certified_result(std::move(run));
    if (drawn.roots)
      Comparison<bin_float>{drawn.scene, true, certificate, result, at_collision, tally}();
    else
      Comparison<Rational>{drawn.scene, false, certificate, result, at_collision, tally}();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_FALSE(has(message, "do not agree"));
    ++tally.refused;
    std::cout << "refused: " << message << "\n";
  }
}

using Draw = Drawn (*)(Random&);

Tally compare_all(Draw draw, std::uint64_t from, std::uint64_t scenes) {
  Tally tally;
  for (std::uint64_t seed = from; seed < from + scenes; ++seed) {
    Random random(seed);
    const Drawn drawn = draw(random);
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + effective_toml(drawn.scene));
    compare(drawn, tally);
    if (testing::Test::HasFailure()) break;
  }
  std::cout << "seeds " << from << " to " << from + scenes - 1 << ": " << tally.proved << " proved, " << tally.undecided
            << " undecided, " << tally.refused << " refused, " << tally.left_out << " too long, " << tally.collisions
            << " collisions, " << tally.numbers << " bounds hold\n";
  return tally;
}

TEST(Certificates, OfListsHoldWhatRationalsGive) { EXPECT_GT(compare_all(draw_list, 1, 60).proved, 40U); }
TEST(Certificates, OfRingsHoldWhatRationalsGive) { EXPECT_GT(compare_all(draw_ring, 1, 30).proved, 20U); }
TEST(Certificates, OfColdGasesHoldWhatRationalsGive) { EXPECT_GT(compare_all(draw_cold, 1, 60).proved, 40U); }
TEST(Certificates, OfRowsHoldWhatRationalsGive) { EXPECT_GT(compare_all(draw_rows, 20, 12).proved, 5U); }

TEST(Certificates, BetweenWallsHoldWhatRationalsGive) { EXPECT_GT(compare_all(draw_walled, 1, 60).proved, 45U); }

TEST(Certificates, OfFallingParticlesHoldWhatAHundredDigitsGive) {
  EXPECT_GT(compare_all(draw_falling, 1, 60).proved, 40U);
}

TEST(SlowCertificates, OfFallingParticles) { EXPECT_GT(compare_all(draw_falling, 600000, 300).proved, 220U); }
TEST(SlowCertificates, BetweenWalls) { EXPECT_GT(compare_all(draw_walled, 500000, 560).proved, 500U); }
TEST(SlowCertificates, OfLists) { EXPECT_GT(compare_all(draw_list, 100000, 3000).proved, 2000U); }
TEST(SlowCertificates, OfRings) { EXPECT_GT(compare_all(draw_ring, 200000, 1000).proved, 600U); }
TEST(SlowCertificates, OfColdGases) { EXPECT_GT(compare_all(draw_cold, 300000, 500).proved, 300U); }
TEST(SlowCertificates, OfRows) { EXPECT_GT(compare_all(draw_rows, 400000, 200).proved, 100U); }

TEST(Certificates, OfReplicasHoldWhatRationalsGive) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    Drawn drawn = draw_ring(random);
    while (drawn.roots) drawn = draw_ring(random);
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + effective_toml(drawn.scene));
    const CertifiedReplicas all = certify_replicas(drawn.scene, 3, 1, {.progress = Progress::Show::never});
    for (const CertifiedReplica& replica : all.replicas) {
      Scene scene = drawn.scene;
      scene.initial.replica = replica.index;
      if (!replica.proved || scene.run.collapse == tools::scene::CollapsePolicy::stop) continue;
      Gas<Rational> gas = gas_of<Rational>(scene);
      gas.advance(of<Rational>(scene.run.until), std::numeric_limits<std::uint64_t>::max());
      EXPECT_EQ(replica.collisions, gas.collisions);
      EXPECT_LE(Rational(replica.energy.low), gas.energy());
      EXPECT_GE(Rational(replica.energy.high), gas.energy());
    }
  }
}

using ProofsOfReplicas = ProgramTest;

// Runs end at their own collapses: each replica counts at the times that it has reached, as in an ensemble.
TEST_F(ProofsOfReplicas, HaveTheStatisticsOfTheirEnsemble) {
  const std::string scene = "collapse_times --set law.restitution=0.6 --set initial.particles=40 "
                            "--set run.until=30 --set output.series.points=31 --replicas 4";
  const Printed printed = shell("cradle certify " + scene + " -o a.h5", 0);
  EXPECT_TRUE(has(printed.out, "proved: 4 of 4 replicas"));
  EXPECT_FALSE(has(printed.out, "nan"));
  shell("cradle ensemble " + scene + " -o ensemble.h5 --quiet", 0);
  const Result proved = read("a.h5"), ensemble = read("ensemble.h5");
  const char* const energy = "ensemble/series/energy";
  EXPECT_EQ(numbers<std::uint64_t>(proved, energy, "count"), numbers<std::uint64_t>(ensemble, energy, "count"));
  const auto mean = numbers(proved, energy, "mean"), expected = numbers(ensemble, energy, "mean");
  const auto sem = numbers(proved, energy, "sem"), expected_sem = numbers(ensemble, energy, "sem");
  ASSERT_EQ(mean.size(), expected.size());
  std::size_t reached = 0;
  for (std::size_t k = 0; k < mean.size(); ++k) {
    if (std::isnan(expected[k])) {
      EXPECT_TRUE(std::isnan(mean[k]));
      continue;
    }
    ++reached;
    EXPECT_NEAR(mean[k], expected[k], 1e-12);
    if (!std::isnan(expected_sem[k])) {
      EXPECT_NEAR(sem[k], expected_sem[k], 1e-12);
    }
  }
  EXPECT_GT(reached, 5U);
  EXPECT_LT(reached, mean.size());
}

}  // namespace cradle::tests::references_test
