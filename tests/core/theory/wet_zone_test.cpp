// The linear model of the late wet shock, equations (9) to (15).
// Proves: both widths agree at k = sqrt 6 only and follow from the profiles by (11) and by the slowing down; the
// momentum handed to a heavy cluster is the momentum lost by the wet law; the force is (14) and (15) in the corrected
// form, to full precision where the printed differences cancel.
#include "cradle/core/theory/wet_zone.hpp"

#include "cradle/tests/core/wet_reference.hpp"

namespace cradle::test::wet_zone_test {

using namespace cradle::theory;

TEST(WetZone, BothWidthsAgreeAtRootSixOnly) {
  for (const WetTurnover& row : turnovers) {
    const auto shock = paper_shock(decimal(row.loss));
    const Wide k = density_excess<Wide>();
    EXPECT_DIGITS(k, "2.449489742783178");
    expect_close(k * k / 6 + k + 1, 2 + k, tiny, "k^2/6 + k + 1 = 2 + k");
    expect_close(half_width_from_energy(shock, k), half_width_from_slowing(shock, k), tiny, "(12) = (13)");
    for (const char* other : {"0", "1", "2.4", "2.5", "10"}) {
      const Wide energy = half_width_from_energy(shock, decimal(other));
      const Wide slowing = half_width_from_slowing(shock, decimal(other));
      EXPECT_EQ(energy > slowing, decimal(other) < k) << other;
    }
  }
  EXPECT_DIGITS(WetZone<Wide>(paper_shock(decimal("1e-4"))).width(), "561.862178");
  EXPECT_DIGITS(WetZone<Wide>(paper_shock(decimal("0.01"))).width(), "5.61862178");
  EXPECT_DIGITS(WetZone<Wide>(paper_shock(decimal("0.05"))).width(), "1.12372436");
}

TEST(WetZone, ProfilesJoinTheRows) {
  const auto shock = paper_shock(decimal("0.05"));
  const WetZone<Wide> zone(shock);
  const Wide edge = zone.half_width();
  expect_close(zone.right_mover_velocity(Wide(-edge)), shock.speed, tiny, "u_+(-L) = u0");
  expect_close(zone.right_mover_velocity(edge), zone.critical_speed(), tiny, "u_+(L) = u_crit");
  expect_close(zone.critical_speed(), 2 * sqrt(decimal("0.05")), tiny, "u_crit");
  expect_close(zone.right_mover_density(Wide(-edge)), 1, tiny, "n_+(-L) = n0");
  expect_close(zone.right_mover_density(edge), 1 + zone.excess(), tiny, "n_+(L) = n0 + n~");
  for (const char* place : {"-0.9", "0.1", "0.5"}) {
    const Wide x = decimal(place) * edge;
    expect_close(zone.right_mover_density(x) + zone.right_mover_density(Wide(-x)), 2 + zone.excess(), tiny,
                 "total density");
    expect_close(zone.right_mover_velocity(x) + zone.right_mover_velocity(Wide(-x)),
                 shock.speed + zone.critical_speed(), tiny, "relative velocity");
  }
}

TEST(WetZone, WidthsAreThoseOfTheirDerivations) {
  const auto shock = paper_shock(decimal("1e-4"));
  const WetZone<Wide> zone(shock);
  const Wide edge = zone.half_width();
  // (11): E int_0^L n_+ n_- u0 dx = m n0 u0^3/2; the integrand is a parabola, for which Simpson's rule is exact
  const auto product = [&](const Wide& x) {
    return Wide(zone.right_mover_density(x) * zone.right_mover_density(Wide(-x)));
  };
  const Wide integral = edge / 6 * (product(Wide(0)) + 4 * product(Wide(edge / 2)) + product(edge));
  expect_close(shock.loss * integral * shock.speed, pow(shock.speed, 3) / 2, tiny, "(11)");
  // (13): dx/dj = u_+/(n_- u0), u_+ = u0 (1 - j/j*): int n_- dx over the zone is j*/2; the trapezoid is exact
  const Wide particles = edge * (zone.right_mover_density(edge) + zone.right_mover_density(Wide(-edge)));
  expect_close(particles, collisions_to_rest(shock) / 2, tiny, "(13)");
  // the speed lost per collision is E/(m u0) in the limit, not E/(m u0^2), and exactly (u0/2)(1 - sqrt(1 - 4E/(m
  // u0^2)))
  const Wide lost = zone_speed_lost(shock);
  expect_close(lost, shock.speed / 2 * (1 - sqrt(Wide(1 - 4 * shock.loss / pow(shock.speed, 2)))), tiny * 10000,
               "step before (13)");
  expect_close(lost, shock.loss / shock.speed, shock.loss / pow(shock.speed, 2) * 2, "its limit");
}

TEST(WetZone, PistonTakesWhatTheParticleLoses) {
  const WetZone<double> zone(paper_shock(0.05));
  // on a cluster much heavier than the particle: m v^2/2 - E_loss is left, or nothing
  for (const double v : {0.32, 0.4472, 0.5, 3.0}) {
    const double after = v - zone.piston_momentum(v);
    EXPECT_NEAR(after * after / 2, v * v / 2 - 0.05, 4 * ulp * v * v) << v;
  }
  for (const double v : {0.0, 0.1, 0.31}) EXPECT_EQ(zone.piston_momentum(v), v) << "m v^2/2 <= E_loss: it sticks";
  // no cancellation for fast particles: E/v (1 + E/(2 v^2) + ...), where v - sqrt(v^2 - 0.1) would have no digit left
  EXPECT_NEAR(zone.piston_momentum(1e9), 0.05 / 1e9, 4 * ulp * 0.05 / 1e9);
  WetShock<double> heavy{0.1, 0.5, 1, 2};
  EXPECT_NEAR(WetZone<double>(heavy).piston_momentum(0.4), 2 * zone.piston_momentum(0.4), 4 * ulp) << "factor m";
}

TEST(WetZone, NoParticleOfTheZoneIsSlowEnoughToStickToACluster) {
  // u_crit = 2 sqrt(E/m): 2E/(m u^2) <= 1/2, at equality at the inner edge
  for (const char* loss : {"1e-6", "0.01", "0.05", "0.0625"}) {
    const auto shock = paper_shock(decimal(loss));
    const WetZone<Wide> zone(shock);
    expect_close(2 * shock.loss / pow(zone.right_mover_velocity(zone.half_width()), 2), Wide(1) / 2, tiny, loss);
  }
  EXPECT_THROW(WetZone<double>(paper_shock(0.0626)), std::domain_error);
  EXPECT_THROW(WetZone<double>(paper_shock(0.0)), std::domain_error);
}

TEST(WetZone, ForcePushesInFromOutsideAndOutFromInside) {
  const WetZone<Wide> zone(paper_shock(decimal("0.05")));
  const Wide edge = zone.half_width();
  EXPECT_DIGITS(zone.row_force(), "0.0563508");
  expect_close(zone.row_force_printed(), decimal("0.05"), tiny, "printed outer force");
  for (const Wide& beyond : {edge, Wide(edge + 1), Wide(100 * edge)}) {
    EXPECT_EQ(zone.force(beyond), Wide(-zone.row_force())) << "only left-movers get there";
    EXPECT_EQ(zone.force(Wide(-beyond)), zone.row_force());
    EXPECT_EQ(zone.right_mover_force(beyond), 0);
    EXPECT_EQ(zone.right_mover_force(Wide(-beyond)), zone.row_force());
    EXPECT_EQ(zone.force_printed(beyond), Wide(-zone.row_force_printed()));
  }
  // inside, the two terms as printed (with the factor m), and their sum
  for (const char* place : {"-0.99", "-0.3", "0.2", "0.9"}) {
    const Wide x = decimal(place) * edge;
    const Wide u = zone.right_mover_velocity(x), v = zone.right_mover_velocity(Wide(-x));
    const auto printed = [&](const Wide& speed, const Wide& density) {
      return Wide(speed * (1 - sqrt(Wide(1 - 2 * decimal("0.05") / (speed * speed)))) * speed * density);
    };
    expect_close(zone.right_mover_force(x), printed(u, zone.right_mover_density(x)), tiny, "(15)");
    expect_close(zone.force(x),
                 printed(u, zone.right_mover_density(x)) - printed(v, zone.right_mover_density(Wide(-x))), tiny * 1000,
                 "(14)");
    EXPECT_EQ(zone.force_printed(x), zone.force(x));
    EXPECT_EQ(zone.force(x) > 0, x > 0) << "outwards";
    EXPECT_EQ(zone.force(Wide(-x)), Wide(-zone.force(x)));
  }
  // right-movers alone are continuous where they come in
  expect_close(zone.right_mover_force(Wide(-edge * (1 - tiny))), zone.row_force(), 10 * tiny, "F_+ at -L");
}

TEST(WetZone, ForceKeepsItsDigitsAtTheCentreAndForSmallLosses) {
  for (const double loss : {0.0625, 0.05, 1e-3, 1e-9}) {
    const WetZone<double> zone(paper_shock(loss));
    const WetZone<Wide> wide(paper_shock(Wide(loss)));
    for (const double part : {1e-12, 1e-6, 0.1, 0.5, 0.9}) {
      const double x = part * zone.half_width();
      // some 40 roundings; the root q = sqrt(1 - v_c^2/u^2) >= sqrt(1/2) does not amplify them
      expect_close(zone.force(x), wide.force(Wide(x)), 40 * ulp, std::to_string(loss));
    }
    expect_close(zone.row_force(), wide.row_force(), 10 * ulp, "outer force");
  }
}

}  // namespace cradle::test::wet_zone_test
