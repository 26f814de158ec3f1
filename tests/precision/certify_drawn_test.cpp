// The checker of proofs against exact arithmetic, in scenes drawn at random of every law, with walls and under gravity.
// Proves: proved collisions are those of the exact gas, bounds contain the exact numbers, accounts of walls included,
// for every state in the balls of the start; a run is never proved if one of its collisions is dropped, exchanged with
// a neighbour's, invented or made on the wrong side of the cut-off.
#include "cradle/tests/precision/drawn_scenes.hpp"

namespace cradle::test::certify_drawn_test {

using namespace cradle::test::drawn;

// The totals are those of proved runs.
const Family families[] = {
    {"Inelastic", draw, 800, {{"runs", 500}}},
    {"Sticky", draw_by<GasLaw::sticky>, 400, {{"runs", 300}, {"merges", 500}}},
    {"Wet", draw_wet, 300, {{"runs", 200}, {"merges", 100}}},
    {"WithWalls", draw_with_walls, 350, {{"runs", 200}, {"walls", 500}}},
    {"SpeedDependent", draw_speed_dependent, 300, {{"runs", 200}, {"collisions", 1500}}},
    {"Falling",
     draw_falling,
     600,
     {{"runs", 400}, {"below cut-off", 100}, {"walls", 1000}, {"ceilings", 100}, {"thermal walls", 200}}},
};

class CertifyDrawn : public testing::TestWithParam<Family> {
 protected:
  // f(scene, its run in the exact gas), for each scene whose run has few collisions.
  template <class F> void for_each_run(std::uint64_t from, std::uint64_t to, F f) const {
    for (std::uint64_t number = from; number < to && !HasFatalFailure(); ++number) {
      SCOPED_TRACE(number);
      const Drawn d = GetParam().draw(number);
      with_gas(d, [&](const auto& gas) {
        if (const auto run = run_of(gas); run.ended) f(d, run, number);
      });
    }
  }
};
INSTANTIATE_TEST_SUITE_P(, CertifyDrawn, testing::ValuesIn(families), [](const auto& row) { return row.param.name; });

template <class T> void expect_state(const Checker<B>& checker, const Drawn& d, const Gas<T>& gas) {
  const CertainState<B> end = checker.state_at(B(until));
  EXPECT_TRUE(holds(end.energy, gas.energy()));
  std::size_t particles = 0;
  checker.for_each(B(until), [&](ParticleIndex particle, const B& m, const B& x, const B& v) {
    const auto& cell = gas.cell_of(particle);
    EXPECT_TRUE(holds(m, cell.m)) << particle;
    EXPECT_TRUE(holds(x, gas.place(cell))) << particle;
    EXPECT_TRUE(holds(v, gas.velocity(cell))) << particle;
    ++particles;
  });
  EXPECT_EQ(particles, gas.cells.size());
  ASSERT_EQ(end.front_left.has_value(), gas.outermost(true) != nullptr);
  if (end.front_left) {
    EXPECT_TRUE(holds(*end.front_left, gas.place(*gas.outermost(true))));
    EXPECT_TRUE(holds(*end.front_right, gas.place(*gas.outermost(false))));
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (!d.walls[side]) continue;
    EXPECT_EQ(end.walls[side].collisions, gas.walls[side]->collisions);
    EXPECT_TRUE(holds(end.walls[side].given, gas.walls[side]->given));
    EXPECT_TRUE(holds(end.walls[side].momentum, gas.walls[side]->momentum));
    EXPECT_TRUE(holds(end.walls[side].dissipated, gas.walls[side]->lost));
  }
}

TEST_P(CertifyDrawn, WhatIsProvedIsWhatTheExactGasGives) {
  Totals found;
  for_each_run(0, GetParam().scenes, [&](const Drawn& d, const auto& run, std::uint64_t) {
    Checker<B> checker(particles_of<B>(d), law_of(d));
    const Collisions collisions = made(d);
    if (!proved(checker, collisions)) return;
    ASSERT_FALSE(run.gas.tied);
    ASSERT_EQ(collisions.size(), run.collisions.size());
    if (d.bounces()) {  // clusters go by other names there
      ASSERT_EQ(digest_of(collisions), digest_of(run.collisions));
    }
    if (d.acceleration != 0) {
      ASSERT_EQ(collisions, run.collisions);
    }
    EXPECT_EQ(checker.proved().merges, run.gas.merges);
    if (d.has_roots() || !(d.law == GasLaw::sticky || law_of(d).elastic)) {
      EXPECT_EQ(checker.proved().below_cutoff, run.gas.below_cutoff);
    }
    expect_state(checker, d, run.gas);
    checker.for_each(B(until), [&](ParticleIndex particle, const B&, const B& x, const B& v) {
      EXPECT_LT(x.radius(), 1e-12) << particle << ", not by being wide";
      EXPECT_LT(v.radius(), d.acceleration != 0 ? 1e-12 : 1e-20) << particle << ", not by being wide";
    });
    ++found["runs"], found["collisions"] += collisions.size(), found["merges"] += run.gas.merges;
    for (std::size_t side = 0; side < 2; ++side) {
      if (!d.walls[side]) continue;
      const std::uint64_t of_wall = run.gas.walls[side]->collisions;
      const bool ceiling = d.acceleration != 0 && (side == 0) != (d.acceleration < 0);
      found[ceiling ? "ceilings" : "walls"] += of_wall;
      if (d.walls[side]->temperature > 0)
        found["thermal walls"] += of_wall;
      else
        found["below cut-off"] += run.gas.below_cutoff;
    }
  });
  expect_at_least(found, GetParam().least);
}

TEST_P(CertifyDrawn, CollisionsOfTheExactGasAreProved) {
  std::uint64_t all = 0, counted = 0;
  for_each_run(600, 900, [&](const Drawn& d, const auto& run, std::uint64_t) {
    if (run.gas.tied) return;
    Checker<B> checker(particles_of<B>(d), law_of(d));
    ++all, counted += proved(checker, run.collisions);
  });
  EXPECT_GE(all, 150U);
  EXPECT_GE(counted, all * 9 / 10);
}

TEST_P(CertifyDrawn, ARunThatIsWrongInOneCollisionIsNeverProved) {
  std::uint64_t refused = 0, wrong_sides = 0;
  for_each_run(0, 300, [&](const Drawn& d, const auto& run, std::uint64_t number) {
    const Collisions& right = run.collisions;
    if (run.gas.tied || right.empty()) return;
    const auto pick = [&](std::uint64_t salt, std::size_t of) { return random_bits(5, number, salt) % of; };
    const auto refuse = [&](const Collisions& wrong) {
      Checker<B> checker(particles_of<B>(d), law_of(d));
      ++refused;
      EXPECT_FALSE(proved(checker, wrong));
    };
    for (std::size_t k = 0; k < right.size(); ++k) {
      Collisions dropped = right;
      dropped.erase(dropped.begin() + static_cast<std::ptrdiff_t>(k));
      refuse(dropped);
    }
    for (std::uint64_t salt = 0; salt < 4; ++salt) {
      // Of neighbours; in scenes with walls also with walls, which are no neighbours where they are not.
      const std::size_t particles = d.gaps.size();
      const bool walled = d.walls[0] || d.walls[1], ring = d.length > 0;
      const std::size_t pairs = walled ? particles + 1 : ring ? particles : particles - 1;
      const auto l = static_cast<ParticleIndex>(pick(salt + 10, pairs)) - (walled ? 1 : 0);
      Collisions invented = right;
      invented.insert(invented.begin() + static_cast<std::ptrdiff_t>(pick(salt + 20, invented.size() + 1)),
                      {l, ring ? (l + 1) % static_cast<ParticleIndex>(particles) : l + 1});
      refuse(invented);
      // Later than the one after it, which shares a particle with it.
      Collisions late = right;
      if (exchange_with_next(late, pick(salt + 30, late.size()))) refuse(late);
      const bool has_sides =
          !walled && !d.has_roots() && d.bounces() && d.cutoff > 0 && std::string(d.restitution) != "1";
      if (!has_sides) continue;
      // This may leave the sequence of collisions unchanged, but not what the run reports beside it.
      const auto other = run_of(gas_of<Rational>(d), pick(salt + 40, right.size()));
      if (!other.ended || other.gas.tied) continue;
      Checker<B> checker(particles_of<B>(d), law_of(d));
      ++wrong_sides;
      EXPECT_FALSE(proved(checker, other.collisions) && checker.proved().below_cutoff == other.gas.below_cutoff &&
                   holds(checker.state_at(B(until)).energy, other.gas.energy()));
    }
  });
  EXPECT_GE(refused, 2000U);
  if (GetParam().draw == draw) {
    EXPECT_GE(wrong_sides, 300U);
  }
}

TEST_P(CertifyDrawn, EveryStateInTheBallsOfTheStartStaysInThem) {
  std::uint64_t counted = 0, on_walls = 0;
  for (std::uint64_t number = 0; number < 250; ++number) {
    SCOPED_TRACE(number);
    Drawn d = GetParam().draw(number);
    d.length = 0;
    with_gas(d, [&](const auto& gas) {
      const auto run = run_of(off_the_middle(gas, number));
      Checker<B> checker(wide_particles(d), law_of(d));
      if (!run.ended || !proved(checker, run.collisions)) return;
      ++counted;
      expect_state(checker, d, run.gas);
      for (const auto& wall : run.gas.walls) on_walls += wall ? wall->collisions : 0;
    });
  }
  EXPECT_GE(counted, 150U);
  EXPECT_GE(on_walls, Totals(GetParam().least)["walls"] / 5);
}

}  // namespace cradle::test::certify_drawn_test
