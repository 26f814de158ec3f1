// Guards are silent on every run that is right, up to very many contacts, and each one speaks where its own thing is
// wrong by far less than what is to be seen in a result.
#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "cradle/core/cluster_chain.hpp"
#include "cradle/core/gap_chain.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/core/position_chain.hpp"
#include "cradle/core/simulation.hpp"
#include "cradle/core/sticky_gas.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace guards_test {

using namespace cradle;
using cradle::test::gaussian_ring;
using cradle::test::uniform_rows;

using Dry = Inelastic<double>;

template <class Run>
GuardLook<double> look_at(const Run& run, const Bodies<double>& bodies, const Configuration<double>& c) {
  return guarded(c, bodies, run.counts().contacts, bodies.kinetic_energy() - run.energy_lost(), c.time,
                 run.last_contact_time(), 0., true);
}

template <class Run> void expect_silent(Run&& run, const Bodies<double>& bodies) {
  for (const double time : {1., 10., 100., 500.}) {
    run.advance(time);
    const auto look = look_at(run, bodies, run.configuration(time));
    ASSERT_FALSE(look.broken) << time << ": guard " << static_cast<int>(look.broken->guard) << ", "
                              << look.broken->found << " > " << look.broken->bound;
  }
}
template <class Chain, class Law>
void expect_silent(const Law& law, const std::shared_ptr<const Bodies<double>>& bodies) {
  expect_silent(Simulation<double, Law, Chain>(law, Chain(bodies, 0.)), *bodies);
}

TEST(Guards, AreSilentOnRunsThatAreRight) {
  for (const auto& bodies : {uniform_rows(300), gaussian_ring(200, 200)}) {
    expect_silent<GapChain<double>>(Dry(.99, 1e-3), bodies);
    expect_silent<GapChain<double>>(Dry(1., 0.), bodies);
    expect_silent<ClusterChain<double>>(Wet<double>(.01), bodies);
    expect_silent(StickyGas<double>(bodies, 0.), *bodies);
  }
  expect_silent<PositionChain<double>>(Dry(.99, 1e-2), uniform_rows(300));
}

class Broken : public testing::Test {
 protected:
  Broken() : bodies_(uniform_rows(300)), run_(Dry(.99, 1e-3), GapChain<double>(bodies_, 0.)) {
    run_.advance(200);
    now_ = run_.configuration(200);
  }
  void expect(Guard guard) const {
    const auto look = look_at(run_, *bodies_, now_);
    ASSERT_TRUE(look.broken);
    EXPECT_EQ(look.broken->guard, guard);
  }

  std::shared_ptr<const Bodies<double>> bodies_;
  Simulation<double, Dry, GapChain<double>> run_;
  Configuration<double> now_;
};

TEST_F(Broken, BodiesThatHaveChangedPlaces) {
  now_.gap[40] = -1e-6;
  expect(Guard::order);
  EXPECT_EQ(look_at(run_, *bodies_, now_).broken->body, now_.index[40]);
}
TEST_F(Broken, AContactThatIsStillToCome) {
  now_.time = run_.last_contact_time() - 1e-6;
  expect(Guard::past);
}
TEST_F(Broken, NotATimeThatIsRoundedAnewFromAnOriginThatHasMoved) {
  now_.time = std::nextafter(run_.last_contact_time(), 0.);
  EXPECT_FALSE(look_at(run_, *bodies_, now_).broken);
}
TEST_F(Broken, Energy) {
  // Momentum stays: two bodies that differ by 1 in velocity are brought nearer to each other by a part in a million.
  now_.v[30] += 1e-6 * (now_.v[60] > now_.v[30] ? -1 : 1);
  now_.v[60] -= 1e-6 * (now_.v[60] > now_.v[30] ? -1 : 1);
  expect(Guard::energy);
}
TEST_F(Broken, Momentum) {
  // Energy stays: a body that is turned round.
  const double before = now_.v[10];
  now_.v[10] = -before;
  expect(Guard::momentum);
}
TEST_F(Broken, Closure) {
  now_.closure_gap = 1e-5;
  expect(Guard::closure);
  now_.closure_gap = 0;
  now_.closure_speed = -1e-6;
  expect(Guard::closure);
}
TEST_F(Broken, WhatIsNoNumber) {
  now_.gap[5] = std::numeric_limits<double>::quiet_NaN();
  expect(Guard::order);
  now_.v[5] = std::numeric_limits<double>::quiet_NaN();
  expect(Guard::energy);
}

}  // namespace guards_test
