// The engine in every scalar type. Proves: all make the collisions of the paper's shock that an independent
// event-driven program counts in double, binary128 and 100 digits alike; all settle the collapse time of three
// particles, of equal and unequal masses, to the full precision of the type; all follow a collapse to the end of their
// range, collision by collision on its closed form: plain double keeps the relative precision of gaps over 300 decades;
// from t = 1e12 a run makes the collisions of one from t = 0 with the same gaps and closing speeds to the last bit, at
// times that are later by 1e12 to 1e-18.
//
// Closed forms (McNamara and Young, Phys. Fluids A 4, 496 (1992)): p_n the closing speed at collision n, g_n the other
// gap then; a_r, a_l the shares of a collision's closing speed handed to the right and to the left gap (both (1+eps)/2
// for equal masses), a^2 = a_l a_r, lam = (a - sqrt(a^2 - 4 eps))/2. With p_n of every second collision scaled by r =
// sqrt(a_r/a_l): t_c = t_0 + g_0/(p_1 - r lam p_0) and g_n p_n = eps^n g_0 p_0. Evaluated with 1300 digits from the
// numbers that the type holds.
//
// Tolerance. Let v be the largest error of one operation. A collision takes 3 roundings of a gap and 6 of a closing
// speed (collisions_down_to), a flight 3 more: the n-th interval is off by 12 (n+1) v. Intervals fall
// by q = lam-/lam+, so all are off by 12 v (t_c - t_0)/(1 - q) together; their sum is rounded once more.
// A run reports t_c = t_0 + g_0/z, z = p_1 - r lam p_0, as the first collision gives it, whose bound is the least here.
// t_0, g_0 and p_0 are exact; p_1 has at most 5 roundings, and r lam, less than p_1/8, at most 24. With those of the
// difference and of the quotient g_0/z is off by 12 v (t_c - t_0) at most.
#ifdef CRADLE_WITH_MPFR

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/slow_loop.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::precision_runs_test {

PRECISION_SUITE(EveryScalarRun, EveryPrecision);
PRECISION_SUITE(SlowScalarRun, EachKindOfPrecision);

struct Count {
  int time;
  std::uint64_t collisions;
};

template <class T> void expect_collisions(const std::vector<Count>& counts) {
  auto run = gap_run(rshock<T>(8000), Inelastic<T>(from_text<T>(".999"), from_text<T>("1e-5")));
  for (const Count& count : counts) {
    ASSERT_EQ(run.advance(T(count.time)), Status::reached);
    EXPECT_EQ(run.counts().collisions, count.collisions) << "t = " << count.time;
    EXPECT_EQ(run.counts().below_cutoff, 0U) << "t = " << count.time;
  }
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

// Where the independent program gives no count.
std::uint64_t collisions_in_double(int time) {
  auto run = gap_run(rshock<double>(8000), Inelastic<double>(0.999, 1e-5));
  run.advance(time);
  return run.counts().collisions;
}

PRECISION_TEST(EveryScalarRun, ShockOfThePapersFigure2) {
  if (TypeParam::digits == 1000)
    expect_collisions<T>({{300, collisions_in_double(300)}});
  else
    expect_collisions<T>({{1999, 1299216}});
}

PRECISION_TEST(SlowScalarRun, ShockOfThePapersFigure2) {
  if (std::same_as<T, double> || std::same_as<T, long double> || std::same_as<T, double_double>)
    expect_collisions<T>({{4000, 4685816}, {6000, 16156905}});
  else
    expect_collisions<T>({{4000, 4685816}});
}

struct Collapse {
  Reference time, ratio;        // t_c and q
  Reference to_right, to_left;  // a_r and a_l
};

// Particles at 0, 1, 3 with velocities 1, 0, -1: t_0 = 1, g_0 = p_0 = 1, the right gap closes at 1 until then.
template <class T> Collapse closed_form(const T& restitution, const std::vector<T>& masses) {
  const Reference eps = reference(restitution);
  const Reference m1 = reference(masses[0]), m2 = reference(masses[1]), m3 = reference(masses[2]);
  const Reference to_right = (1 + eps) * m1 / (m1 + m2), to_left = (1 + eps) * m3 / (m2 + m3);
  const Reference a = sqrt(to_right * to_left), r = sqrt(to_right / to_left), root = sqrt(a * a - 4 * eps);
  const Reference slow = (a - root) / 2;
  return {1 + 1 / (1 + to_right - r * slow), (a - root) / (a + root), to_right, to_left};
}

// How far off the time of a collapse may be that has been followed to its end.
template <class T> Reference of_rounding(const Collapse& collapse) {
  return 12 * rounding<T>() * (collapse.time - 1) / (1 - collapse.ratio) +
         2 * reference(std::numeric_limits<T>::epsilon()) * collapse.time;
}

template <class T, class Run> void expect_collapse_time(Run run, const Collapse& expected) {
  ASSERT_EQ(run.advance(T(1000)), Status::collapsed);
  ASSERT_TRUE(run.collapse().settled);
  EXPECT_LE(abs(reference(run.collapse().time) - expected.time), of_rounding<T>(expected));
  EXPECT_LE(run.chain().account().order_lost, 0U);
}

// Heavy outer particles collapse at larger restitution: q < 1/2 in all of these.
PRECISION_TEST(EveryScalarRun, TimeIsSettledToFullPrecision) {
  const struct {
    const char* restitution;
    std::vector<double> masses;
    const char* published = nullptr;
  } rows[] = {{".05", {1, 1, 1}, "1.7142857142857142857142857142857142857142857142857"},
              {".01", {1, 1, 1}, "1.6736937682559527405521559675474991365441632665957"},
              {".0625", {1, 1, 1}, "1.7377984054260977582367587110958928498213699562943"},
              {".1", {3, 1, 2}},
              {".05", {1, 1, 5}},
              {".01", {2, 3, 1}},
              {".15", {1000, 1, 7}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.restitution);
    const T restitution = from_text<T>(row.restitution);
    const std::vector<T> masses = numbers<T>(row.masses);
    const Collapse expected = closed_form(restitution, masses);
    ASSERT_LT(expected.ratio, 0.5);
    const Inelastic<T> law(restitution, T(0));
    const Policy<T> policy = stop_below(T(0));
    expect_collapse_time<T>(mass_run(three_particles(masses), law, policy), expected);
    if (!row.published) continue;
    // That is the time of the decimal: 49 digits, and what the type makes of the decimal (dt_c/deps < 8).
    EXPECT_LE(abs(expected.time - Reference(row.published)), Reference("1e-48") + 8 * rounding<T>());
    expect_collapse_time<T>(gap_run(three_particles<T>({}), law, policy), expected);
  }
}

// Every collision lies on the closed form, with p_1 = 1 + a_r p_0 and p_{n+1} = a p_n - eps p_{n-1}, a being a_r or
// a_l. Returns how many collisions it takes to a gap below `least`.
//
// Bound on the invariant. With the origin of time at the last collision, the next one is at g/p (one rounding), the
// other gap then is (eps p_before) times that (two roundings): three roundings a collision, however p is rounded.
// Bound on the speeds. Each p is formed from two others with three roundings, errors inherit the recursion's growth
// lam+; relative to p_n, with p_n > 0 falling by lam+ a collision, every collision adds at most
// 3 v (a + eps/lam+)/lam+ < 6 v for these.
template <class Chain>
std::uint64_t collisions_down_to(const char* least, double given, const std::vector<double>& weights) {
  using T = typename Chain::Scalar;
  const T restitution = cradle::exactly<T>(given), stop = from_text<T>(least);
  const std::vector<T> masses = numbers<T>(weights);
  SlowLoop loop(Inelastic<T>(restitution, T(0)), Chain(three_particles(masses), T(0)));
  const Reference eps = reference(restitution), v = rounding<T>();
  const Collapse expected = closed_form(restitution, masses);
  Reference invariant(1), before(0), p(1);
  std::uint64_t n = 0;
  for (bool down = false; !down; ++n) {
    const auto s = loop.next();
    if (!s || testing::Test::HasFailure()) return 0;
    const Step<T> step = loop.collide(*s);
    const Reference closing = reference(step.closing_speed);
    EXPECT_EQ(step.particle, static_cast<ParticleIndex>(n % 2));
    EXPECT_LE(abs(reference(step.nearest_gap) * closing - invariant), 3 * n * v * invariant) << "collision " << n;
    EXPECT_LE(abs(closing - p), 6 * n * v * p) << "collision " << n;
    invariant *= eps;
    const Reference share = n % 2 == 0 ? expected.to_right : expected.to_left;
    before = std::exchange(p, n == 0 ? Reference(1 + share) : Reference(share * p - eps * before));
    down = step.nearest_gap < stop;
    if (!down) continue;
    // What is left of the way, g/(p_{n+1} - r lam p_n), is less than twice the next interval, as q < 1/2.
    EXPECT_LE(abs(reference(step.time) - expected.time),
              of_rounding<T>(expected) + 2 * reference(step.nearest_gap) / p);
  }
  return n;
}

// A run follows the collapse as far as its policy says, by the same collisions.
template <class Chain>
void expect_followed_down_to(const char* least, double restitution, const std::vector<double>& masses) {
  using T = typename Chain::Scalar;
  SCOPED_TRACE(testing::Message() << "eps = " << restitution << " down to " << least);
  const T stop = from_text<T>(least);
  Simulation run(Inelastic<T>(cradle::exactly<T>(restitution), T(0)), Chain(three_particles(numbers<T>(masses)), T(0)),
                 stop_below(stop));
  ASSERT_EQ(run.advance(T(1000)), Status::collapsed);
  EXPECT_EQ(run.counts().collisions, collisions_down_to<Chain>(least, restitution, masses));
  EXPECT_TRUE(run.collapse().gap < stop && run.collapse().gap > T(0));
  EXPECT_TRUE(run.collapse().gap > stop / T(256)) << "a collision takes it down by lam- > 1/50";
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

PRECISION_TEST(EveryScalarRun, GapsAreFollowedToTheEndOfTheRange) {
  for (const ThreeCollapse& row : three_collapses)
    expect_followed_down_to<GapChain<T>>("1e-290", row.restitution(), {1, 1, 1});
  expect_followed_down_to<GapChain<T, IndividualMasses<T>>>("1e-290", 0.1, {3, 1, 2});
  if (std::same_as<T, double> || std::same_as<T, double_double>) return;
  expect_followed_down_to<GapChain<T>>("1e-4000", 0.05, {1, 1, 1});
  if (TypeParam::digits > 0) expect_followed_down_to<GapChain<T>>("1e-20000", 0.05, {1, 1, 1});
}

TEST(CollapseInDouble, TheGapPassesEveryDecadeAtTheRightCollision) {
  constexpr std::array decades{"1e-16", "1e-34", "1e-100", "1e-300"};
  for (const ThreeCollapse& row : three_collapses)
    for (std::size_t k = 0; k < decades.size(); ++k) {
      EXPECT_EQ(collisions_down_to<GapChain<double>>(decades[k], row.restitution(), {1, 1, 1}), row.passes[k])
          << row.eps << " down to " << decades[k];
      if (k < 3) expect_followed_down_to<GapChain<double>>(decades[k], row.restitution(), {1, 1, 1});
    }
}

// ---- a run that starts late, at t = 1e12, where a double resolves 1e-4
//
// Times are kept as a sum of two numbers; a move of the origin rounds the lower one, which is at most half a unit in
// the last place of 1e12, 2^-14 in double, to 53 bits: 2^-68 a move, 3.4e-21. The scenes here move it some tens of
// times: below 1e-18 even if all roundings had the same sign, and that much more exact in wider types.

using Precisions = testing::Types<Precision<double>, Precision<double_double>, Precision<Mpfr<4>, 30>>;
PRECISION_SUITE(LateStart, Precisions);

template <class T> struct Seen {
  ParticleIndex left;
  Reference time;
  T closing_speed;
  std::vector<T> gaps;  // of all, at this collision: to read one at a given time would round that time
};

template <class T>
void expect_same_run(const Scene<T>& particles, const Inelastic<T>& law, int end, Policy<T> policy = {}) {
  const T late(std::int64_t{1000000000000}), shift(end);
  auto early_run = gap_run(particles, law, policy), late_run = gap_run(particles, law, policy, late);
  std::vector<Seen<T>> early_collisions, late_collisions;
  const auto into = [](std::vector<Seen<T>>& all, const auto& run) {
    return [&](const Collision<T>& c) {
      const auto& chain = run.chain();
      const Slot chosen = chain.first() + static_cast<Slot>(c.left - chain.particle(chain.first()));
      all.push_back({c.left, reference(c.time), c.closing_speed, {}});
      for (Slot s = chain.first(); s <= chain.last(); ++s)
        all.back().gaps.push_back(chain.gap_at(s, chain.due(chosen)));
    };
  };
  const Status status = early_run.advance(shift, into(early_collisions, early_run));
  ASSERT_EQ(late_run.advance(late + shift, into(late_collisions, late_run)), status);

  ASSERT_TRUE(identical(early_run.counts(), late_run.counts()));
  ASSERT_LE(early_run.counts().origin_moves, 147U) << "the bound needs fewer than 1e-18 2^68/2 moves a run";
  ASSERT_EQ(early_collisions.size(), late_collisions.size());
  for (std::size_t n = 0; n < early_collisions.size(); ++n) {
    const Seen<T>&a = early_collisions[n], &b = late_collisions[n];
    ASSERT_EQ(a.left, b.left) << n;
    ASSERT_TRUE(a.closing_speed == b.closing_speed && a.gaps == b.gaps) << n;
    ASSERT_LE(abs(b.time - 1e12 - a.time), 1e-18) << n;
  }
  if (status != Status::reached) return;
  const auto a = configuration_at(early_run, shift), b = configuration_at(late_run, T(late + shift));
  EXPECT_TRUE(a.closing_speed == b.closing_speed);
  EXPECT_TRUE(a.v == b.v);
  EXPECT_EQ(a.gap.size(), b.gap.size());
  EXPECT_TRUE(early_run.energy_lost() == late_run.energy_lost());
}

PRECISION_TEST(LateStart, MakesTheSameCollisions) {
  expect_same_run(rmix<T>(32), Inelastic<T>(T(15) / T(16), T(0)), 1000);
  expect_same_run(rshock<T>(200), Inelastic<T>(from_text<T>(".9"), from_text<T>("1e-3")), 58);
  // Gaps fall to 1e-30 while time advances at 1e12.
  expect_same_run(list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}), Inelastic<T>(from_text<T>(".05"), T(0)), 2,
                  stop_below(from_text<T>("1e-30")));
}

}  // namespace cradle::test::precision_runs_test

#endif
