// The checker of proofs against exact rational arithmetic. Proves: proved collisions are those of the exact gas, bounds
// contain the exact numbers, and a run is never proved if one of its collisions is dropped, exchanged with a
// neighbour's, invented or made on the wrong side of the cut-off.
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "cradle/core/initial/ring.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/tests/precision/drawn_scenes.hpp"
#include "cradle/tests/precision/wrong_runs.hpp"

namespace certify_test {

using namespace cradle;
using namespace cradle::test;
using namespace cradle::test::drawn;

void compare_with_the_exact_gas(bool sticky, std::uint64_t scenes, std::uint64_t least_proved) {
  std::uint64_t counted = 0;
  for (std::uint64_t number = 0; number < scenes; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw(number, sticky);
    const ExactRun run = exact_run(d);
    if (!run.ended) continue;
    Checker<B> checker(particles_of<B>(d), law_of(d));
    const Collisions collisions = made(d);
    if (!proved(checker, collisions)) continue;
    EXPECT_TRUE(sticky || law_of(d).elastic || checker.proved().below_cutoff == run.below);
    ++counted;
    ASSERT_FALSE(run.tied);
    ASSERT_EQ(collisions.size(), run.collisions.size());
    ASSERT_TRUE(sticky || digest_of(collisions) == run.digest);  // clusters go by other names there
    ASSERT_TRUE(holds(checker.state_at(B(until)).energy, run.gas.energy()));
    std::size_t k = 0;
    checker.for_each(B(until), [&](ParticleIndex particle, const B&, const B& x, const B& v) {
      if (sticky) {  // by any of its particles
        ++k;
        return;
      }
      EXPECT_TRUE(holds(x, run.gas.place(run.gas.cell_of(particle)))) << particle;
      EXPECT_TRUE(holds(v, run.gas.cell_of(particle).v)) << particle;
    });
    EXPECT_EQ(k, sticky ? run.gas.cells.size() : 0U);
  }
  EXPECT_GE(counted, least_proved);
}

TEST(Certify, WhatIsProvedOfInelasticParticlesIsWhatRationalsGive) { compare_with_the_exact_gas(false, 800, 500); }
TEST(Certify, WhatIsProvedOfStickyParticlesIsWhatRationalsGive) { compare_with_the_exact_gas(true, 400, 300); }

TEST(Certify, CollisionsOfTheExactGasAreProved) {
  const auto inelastic = [](std::uint64_t number) { return draw(number, false); };
  EXPECT_GE(proved_of_exact_runs(0, 500, inelastic, [](const Drawn& d) { return exact_run(d); }).proved, 400U);
}

TEST(Certify, ARunThatIsWrongInOneCollisionIsNeverProved) {
  std::uint64_t mutants = 0, of_side = 0;
  for (std::uint64_t number = 0; number < 500; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw(number, number % 4 == 3);
    const ExactRun run = exact_run(d);
    if (!run.ended || run.tied || run.collisions.empty()) continue;
    WrongRuns wrong(d, run.collisions, 5, number);
    const bool has_sides = !d.sticky && d.cutoff > 0 && std::string(d.restitution) != "1";
    for (std::uint64_t salt = 0; salt < 2; ++salt) {
      wrong.refuse_dropped(wrong.pick(salt, run.collisions.size()));
      wrong.refuse_invented(salt);
      wrong.refuse_late(salt);
      const ExactRun other_side = exact_run(d, wrong.pick(salt + 40, run.collisions.size()));
      if (has_sides && other_side.ended && !other_side.tied)
        wrong.refuse(other_side.collisions, Said{other_side.below, other_side.gas.energy()}), ++of_side;
    }
    mutants += wrong.refused();
  }
  EXPECT_GE(mutants, 2000U);
  EXPECT_GE(of_side, 300U);
}

#ifdef CRADLE_WITH_MPFR
// The wet law has roots, which rationals have not: the engine itself with 50 digits is the reference.
TEST(Certify, WhatIsProvedOfWetParticlesIsWhatFiftyDigitsGive) {
  using Wide = Mpfr<4>;
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(50));
  std::uint64_t counted = 0, merged = 0;
  for (std::uint64_t number = 0; number < 300; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw(number, false);
    CertainLaw<B> law;
    law.kind = CertainLaw<B>::Kind::wet;
    law.loss = B(1 + static_cast<int>(number % 7)) / B(8);
    Collisions collisions;
    Simulation run(Wet<double>((1 + static_cast<int>(number % 7)) / 8.),
                   ClusterChain<double>(particles_of<double>(d), 0.));
    run.advance(until, [&](const Collision<double>& c) { collisions.emplace_back(c.left, c.right); });
    Checker<B> checker(particles_of<B>(d), law);
    if (!proved(checker, collisions)) continue;
    ++counted;
    const auto wide_particles = particles_of<Wide>(d);
    Simulation wide(Wet<Wide>(Wide(1 + static_cast<int>(number % 7)) / Wide(8)),
                    ClusterChain<Wide>(wide_particles, Wide(0)));
    wide.advance(Wide(until));
    ASSERT_EQ(wide.counts().collisions, collisions.size());
    ASSERT_EQ(wide.counts().merges, checker.proved().merges);
    merged += checker.proved().merges;
    const auto holds_wide = [](const B& x, const Wide& value) {
      const auto high = to_double(value), low = to_double(Wide(value - Wide(high)));
      const Rational off = exact(x) - exactly(high) - exactly(low);
      return (off < 0 ? -off : off) <= exactly(x.radius()) + exactly(std::abs(high) * 0x1p-100);
    };
    EXPECT_TRUE(holds_wide(checker.state_at(B(until)).energy, wide_particles->kinetic_energy() - wide.energy_lost()));
    if (d.length > 0) continue;  // places of a ring are counted from another one
    const auto now = wide.configuration(Wide(until));
    checker.for_each(B(until), [&](ParticleIndex particle, const B&, const B& x, const B& v) {
      for (std::size_t j = 0; j < now.index.size(); ++j) {
        if (now.index[j] != particle) continue;
        EXPECT_TRUE(holds_wide(x, now.x[j])) << particle;
        EXPECT_TRUE(holds_wide(v, now.v[j])) << particle;
      }
    });
  }
  EXPECT_GE(counted, 200U);
  EXPECT_GE(merged, 100U);
}
#endif

// Elastic particles of nearly equal masses that all approach each other, and so had no collisions before, make n - 1,
// n (n - 1)/2 or (n + 1) n (n - 1)/6 collisions in all (A. Knauf and M. Stepan, arXiv 1109.6242); none is left.
TEST(Certify, ElasticParticlesOfNearlyEqualMassesMakeAsManyCollisionsAsTheyCan) {
  using Texts = std::vector<std::string>;
  const auto proved_of = [](const Texts& x, const Texts& v, const Texts& m) -> std::uint64_t {
    const auto list = [&]<class T>(T) {
      std::vector<T> columns[3];
      for (std::size_t k = 0; k < x.size(); ++k)
        for (const auto& [to, from] : {std::pair{0, &x}, {1, &v}, {2, &m}})
          columns[to].push_back(from_text<T>((*from)[k]));
      return std::make_shared<List<T>>(columns[0], columns[1], columns[2]);
    };
    Collisions collisions;
    Simulation run(Inelastic<double>(1.), GapChain<double, IndividualMasses<double>>(list(0.), 0.));
    run.advance(100., [&](const Collision<double>& c) { collisions.emplace_back(c.left, c.right); });
    Checker<B> checker(list(B()), CertainLaw<B>());
    EXPECT_FALSE(checker.state_at(B(0)).over);
    EXPECT_FALSE(checker.collisions(collisions));
    const CertainState<B> end = checker.state_at(B(100));
    EXPECT_FALSE(end.doubt);
    EXPECT_TRUE(end.over);
    return checker.proved().collisions;
  };
  EXPECT_EQ(proved_of({"0.617", "0.927", "0.953"}, {"-0.6", "-0.914", "-0.929"}, {"1", "1.05", "0.99"}), 2U);
  EXPECT_EQ(proved_of({"-0.81", "-0.54", "0.11"}, {"0.78", "0.57", "-0.1"}, {"1", "1", "1.01"}), 3U);
  EXPECT_EQ(proved_of({"-0.753", "-0.749", "0.877"}, {"0.787", "0.774", "-0.9"}, {"1", "0.95", "1"}), 4U);
  EXPECT_EQ(proved_of({"-1.641", "-0.559", "-0.178", "0.603"}, {"0.973", "0.9415", "0.9339", "-0.3165"},
                      {"0.98", "1.07", "1.1", "1.1"}),
            3U);
  EXPECT_EQ(proved_of({"-0.818", "-0.4", "-0.325", "0.141"}, {"0.8", "0.39", "0.3", "-0.134"}, {"1", "1", "1", "1.02"}),
            6U);
  EXPECT_EQ(proved_of({"-1.000002459", "-0.999374889", "-0.972827509", "1"}, {"1", "0.999359194", "0.97232206", "-1"},
                      {"0.9171516", "0.9097226", "0.966177", "1.0627597"}),
            10U);
}

TEST(Certify, FrontsAreTheOutermostOfAllRegions) {
  const std::vector<B> places{B(0), B(1), B(10), B(11), B(20), B(21)}, speeds{B(1), B(0), B(0), B(0), B(1), B(0)};
  CertainLaw<B> law;
  law.restitution = B(0.5);
  Checker<B> checker(std::make_shared<List<B>>(places, speeds), law);
  ASSERT_FALSE(checker.collision(4, 5));
  ASSERT_FALSE(checker.collision(0, 1));
  const auto end = checker.state_at(B(3.5));
  ASSERT_FALSE(end.doubt);
  EXPECT_TRUE(holds(*end.front_left, exactly(1.625)));
  EXPECT_TRUE(holds(*end.front_right, exactly(22.875)));
}

TEST(Certify, ATieIsOpenAndNamesTheParticles) {
  // The middle one is hit from both sides at once.
  const auto particles =
      std::make_shared<List<B>>(std::vector<B>{B(-1), B(0), B(1)}, std::vector<B>{B(1), B(0), B(-1)});
  CertainLaw<B> law;
  law.restitution = from_text<B>("0.9");
  Checker<B> checker(particles, law);
  EXPECT_FALSE(checker.begin());
  EXPECT_FALSE(checker.collision(0, 1));
  const auto doubt = checker.collision(1, 2);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->check, Check::later);
  EXPECT_FALSE(doubt->refuted);
  EXPECT_EQ(doubt->left, 1);
  EXPECT_EQ(doubt->right, 2);
}

TEST(Certify, CollisionsThatShareNoParticleMayComeInAnyOrder) {
  // Two pairs that meet at one moment, far from each other.
  const auto particles =
      std::make_shared<List<B>>(std::vector<B>{B(-11), B(-9), B(9), B(11)}, std::vector<B>{B(1), B(-1), B(1), B(-1)});
  CertainLaw<B> law;
  law.restitution = from_text<B>("0.9");
  for (const Collisions& collisions : {Collisions{{0, 1}, {2, 3}}, Collisions{{2, 3}, {0, 1}}}) {
    Checker<B> checker(particles, law);
    EXPECT_TRUE(proved(checker, collisions));
    EXPECT_EQ(checker.proved().in_doubles, 2U);
  }
}

TEST(Certify, ParticlesThatAreNotInOrderForSureAreNoStart) {
  const auto particles = std::make_shared<List<B>>(std::vector<B>{B(0), B(1)}, std::vector<B>{B(0), B(0)});
  CertainLaw<B> law;
  EXPECT_FALSE(Checker<B>(particles, law).begin());
  EXPECT_THROW(List<B>({B(double_double(0), 1), B(double_double(1), 1)}, {B(0), B(0)}), std::invalid_argument);
}

// ---- collisions side by side

using Pairs = std::vector<std::pair<ParticleIndex, ParticleIndex>>;

// All that a checker knows, to the bit.
struct Known {
  std::uint64_t collisions, in_doubles, below_cutoff;
  std::vector<double> lines;
  friend bool operator==(const Known&, const Known&) = default;
};
void add(std::vector<double>& to, const B& x) {
  to.insert(to.end(), {x.middle().high(), x.middle().low(), x.radius()});
}
Known known(const Checker<B>& checker) {
  Known all{checker.proved().collisions, checker.proved().in_doubles, checker.proved().below_cutoff, {}};
  checker.for_each(B(0),
                   [&](ParticleIndex, const B&, const B& x, const B& v) { add(all.lines, x), add(all.lines, v); });
  const auto last = checker.state_now();
  add(all.lines, last.time), add(all.lines, last.closing);
  return all;
}

// One checker is given the collisions one by one, the other one in pieces of so many.
void compare_side_by_side(const std::shared_ptr<const Particles<B>>& particles, const CertainLaw<B>& law,
                          const Pairs& collisions, std::size_t piece, bool proves) {
  Checker<B> one(particles, law), many(particles, law);
  std::optional<Doubt<B>> doubt;
  std::optional<DoubtAt<B>> at;
  for (std::size_t k = 0; k < collisions.size() && !doubt; k += piece) {
    const std::span<const Checker<B>::Pair> some =
        std::span(collisions).subspan(k, std::min(piece, collisions.size() - k));
    at = many.collisions(some);
    std::size_t number = 0;
    for (; number < some.size() && !doubt; ++number) doubt = one.collision(some[number].first, some[number].second);
    ASSERT_EQ(doubt.has_value(), at.has_value());
    if (!doubt) {
      if (k % 97 < piece) {
        ASSERT_EQ(known(one), known(many));
      }
      continue;
    }
    EXPECT_EQ(at->number + 1, number);
    EXPECT_EQ(at->doubt.check, doubt->check);
    EXPECT_EQ(at->doubt.refuted, doubt->refuted);
    EXPECT_EQ(at->doubt.left, doubt->left);
    EXPECT_EQ(at->doubt.right, doubt->right);
    std::vector<double> quantities, of_one;
    add(quantities, at->doubt.first), add(quantities, at->doubt.second);
    add(of_one, doubt->first), add(of_one, doubt->second);
    EXPECT_EQ(quantities, of_one);
    EXPECT_EQ(many.proved().collisions, one.proved().collisions);
    EXPECT_EQ(many.proved().in_doubles, one.proved().in_doubles);
    EXPECT_EQ(many.proved().below_cutoff, one.proved().below_cutoff);
  }
  EXPECT_EQ(doubt.has_value(), !proves);
}

template <class T> std::shared_ptr<const Particles<T>> shock(ParticleIndex particles) {
  return std::make_shared<Rows<T>>(symmetric_rows<T>(particles, T(1) / T(2), T(1), uniform_displacement(0.1, 3, 0)));
}
template <class T> std::shared_ptr<const Particles<T>> gas(ParticleIndex particles) {
  return std::make_shared<Ring<T>>(particles, T(particles), T(1), gaussian_velocity(5, 0),
                                   uniform_displacement(0.3, 5, 0));
}

struct Proposed {
  std::shared_ptr<const Particles<B>> particles;
  CertainLaw<B> law;
  Pairs collisions;
};
Proposed propose(bool ring, ParticleIndex particles, const char* restitution, double cutoff, double end) {
  Proposed run;
  run.particles = ring ? gas<B>(particles) : shock<B>(particles);
  run.law.restitution = from_text<B>(restitution);
  run.law.elastic = std::string(restitution) == "1";
  if (cutoff > 0) run.law.cutoff = B(cutoff);
  Simulation proposals(Inelastic<double>(std::stod(restitution), cutoff),
                       GapChain<double>(ring ? gas<double>(particles) : shock<double>(particles), 0.));
  proposals.advance(end, [&](const Collision<double>& c) { run.collisions.emplace_back(c.left, c.right); });
  return run;
}
std::vector<Proposed> proposals() {
  return {propose(false, 200, "0.97", 0.01, 150), propose(false, 200, "0.9", 0.25, 120),
          propose(true, 300, "0.9", 0.5, 20), propose(true, 150, "1", 0, 10), propose(true, 60, "0.3", 0.125, 60)};
}

TEST(Certify, SideBySideCollisionsHaveTheBitsOfOneByOne) {
  std::uint64_t below = 0;
  for (const Proposed& run : proposals()) {
    ASSERT_GT(run.collisions.size(), 500U);
    for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{500}, run.collisions.size()})
      compare_side_by_side(run.particles, run.law, run.collisions, piece, true);
    Checker<B> checker(run.particles, run.law);
    ASSERT_FALSE(checker.collisions(run.collisions));
    EXPECT_GT(checker.proved().in_doubles, run.collisions.size() * 9 / 10);
    below += checker.proved().below_cutoff;
  }
  EXPECT_GT(below, 1000U);
}

TEST(Certify, SideBySideCollisionsAreInDoubtWhereTheyAreOneByOne) {
  std::uint64_t mutants = 0;
  for (const Proposed& run : proposals()) {
    for (std::uint64_t number = 0; number < 40; ++number) {
      SCOPED_TRACE(number);
      const auto pick = [&](std::uint64_t salt, std::size_t of) { return random_bits(9, number, salt) % of; };
      Pairs changed = run.collisions;
      for (std::uint64_t error = 0; error <= number % 3; ++error) {  // the first of several is the one in doubt
        const auto at = changed.begin() + static_cast<std::ptrdiff_t>(pick(error, changed.size() - 60));
        const auto count = run.particles->count();
        const auto left = static_cast<ParticleIndex>(pick(10 + error, static_cast<std::size_t>(count - 1)));
        if (number % 4 == 0) changed.erase(at);
        if (number % 4 == 1) changed.insert(at, {left, left + 1});
        if (number % 4 == 2) changed.insert(at, {left, left + 2});
        if (number % 4 == 3)
          for (auto next = at + 1; next < changed.end(); ++next)
            if (*next != *at && shares_a_particle(*at, *next)) {
              std::iter_swap(at, next);
              break;
            }
      }
      compare_side_by_side(run.particles, run.law, changed, 1 + pick(20, 3000), false);
      ++mutants;
    }
  }
  EXPECT_EQ(mutants, 200U);
}

TEST(Certify, SideBySideASpeedThatMayBeZeroIsOpen) {
  const B slow(double_double(1e-30), 1e-29);
  const auto particles =
      std::make_shared<List<B>>(std::vector<B>{B(0), B(1), B(10), B(11)}, std::vector<B>{slow, B(0), B(1), B(0)});
  CertainLaw<B> law;
  law.restitution = from_text<B>("0.9");
  compare_side_by_side(particles, law, {{0, 1}, {2, 3}}, 2, false);
}

TEST(Certify, SideBySideASpeedJustAtTheCutoffIsOpen) {
  const auto particles =
      std::make_shared<List<B>>(std::vector<B>{B(0), B(1), B(10), B(11)}, std::vector<B>{B(1), B(0), B(2), B(0)});
  CertainLaw<B> law;
  law.restitution = from_text<B>("0.9");
  law.cutoff = B(1);
  compare_side_by_side(particles, law, {{0, 1}, {2, 3}}, 2, false);
}

// Without the circumference the time of the first collision would be (0.1 - 0.9)/6: before the start, but later than
// the time of "no collision yet".
TEST(Certify, SideBySideACollisionOverTheSeamOfAShortRingIsComputedAlone) {
  const std::vector<B> x{from_text<B>("0.1"), from_text<B>("0.6"), from_text<B>("0.9")}, v{B(-3), B(0), B(3)};
  CertainLaw<B> law;
  law.restitution = from_text<B>("0.9");
  compare_side_by_side(std::make_shared<List<B>>(x, v, std::vector<B>{}, B(1)), law, {{2, 0}, {1, 2}, {0, 1}}, 3, true);
}

TEST(Certify, SideBySideCollisionsOfDrawnScenes) {
  for (std::uint64_t number = 0; number < 500; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw(number, false);
    const Collisions collisions = made(d);
    Checker<B> checker(particles_of<B>(d), law_of(d));
    bool proves = true;
    for (const auto& [left, right] : collisions) proves = proves && !checker.collision(left, right);
    compare_side_by_side(particles_of<B>(d), law_of(d), collisions, 1 + number % 50, proves);
  }
}

}  // namespace certify_test
