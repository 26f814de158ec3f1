// The filtered queue: 64-bit keys made from rounded times, exact times only where keys are too close to call. Proves it
// equal to a loop that looks through all gaps for the least (exact time, position): the same contacts in the same order
// at each gap, at the same times to the last bit, in scenes that collapse and in shocks. Where many contacts fall on
// the same time by construction, in lattices, contacts that commute may swap, and rounding decides triple collisions:
// there every single choice is checked, against all gaps that could claim to come first. The number of index bits in a
// key changes no bit of a run.
//
// The twin moves its origin of time where the run did (after the same number of contacts, by the same offset), since
// times are rounded as offsets; it knows nothing else of the run.
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace filtered_queue_test {

using namespace cradle;
using namespace cradle::test;

template <class P> using FilteredQueue = InPrecision<P>;
TYPED_TEST_SUITE(FilteredQueue, WidePrecision, PrecisionName);

// Contacts, in order, at a gap and its right neighbour.
template <class T> using Events = std::map<BodyIndex, std::vector<std::pair<BodyIndex, T>>>;

template <class T> void note(Events<T>& events, BodyIndex body, const T& time) {
  events[body].push_back({body, time});
  events[body - 1].push_back({body, time});
}

template <class T> struct Origin {
  std::uint64_t contacts;  // made before it moved
  T offset;                // to where
};

template <class T> struct Recorded {
  Events<T> events;
  std::vector<Origin<T>> origins;
  Counts counts;
};

template <class T>
Recorded<T> filtered(const Scene<T>& bodies, const Inelastic<T>& law, const T& end, Policy<T> policy) {
  auto run = gap_run(bodies, law, std::move(policy));
  Recorded<T> record;
  T last(0);
  const auto take_origin = [&] {
    if (run.counts().origin_moves > record.origins.size()) record.origins.push_back({run.counts().contacts, last});
  };
  run.advance(end, [&](const Contact<T>& contact) {
    take_origin();
    const Slot s = static_cast<Slot>(contact.left - run.chain().body(0));
    last = run.chain().due(s);
    note(record.events, contact.left, contact.time.value());
  });
  take_origin();
  record.counts = run.counts();
  EXPECT_EQ(record.origins.size(), run.counts().origin_moves);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
  return record;
}

template <class T> Events<T> unfiltered(const Scene<T>& bodies, const Inelastic<T>& law, const Recorded<T>& run) {
  GapChain<T> chain(bodies, T(0));
  Events<T> events;
  auto origin = run.origins.begin();
  for (std::uint64_t n = 1; n <= run.counts.contacts; ++n) {
    Slot first = chain.slots();
    T time(0);
    for (Slot s = chain.first(); s <= chain.last(); ++s) {
      if (!(chain.closing(s) > T(0))) continue;
      const T due = chain.due(s);
      if (first == chain.slots() || due < time) first = s, time = due;
    }
    if (first == chain.slots()) break;
    note(events, chain.body(first), chain.stamp(time).value());
    const Collision<T> collision = chain.collide(law, first, time);
    if (asks(collision.notice, Notice::needs_slots)) chain.make_room();
    if (origin != run.origins.end() && origin->contacts == n) chain.move_origin((origin++)->offset);
  }
  return events;
}

template <class T>
void expect_same_contacts(const Scene<T>& bodies, const Inelastic<T>& law, const T& end, std::uint64_t least_contacts,
                          Policy<T> policy = {}) {
  const Recorded<T> run = filtered(bodies, law, end, std::move(policy));
  EXPECT_GE(run.counts.contacts, least_contacts);
  const Events<T> twin = unfiltered(bodies, law, run);
  ASSERT_EQ(run.events.size(), twin.size());
  for (const auto& [body, events] : run.events) {
    const auto& expected = twin.at(body);
    ASSERT_EQ(events.size(), expected.size()) << "gap " << body;
    for (std::size_t k = 0; k < events.size(); ++k) {
      ASSERT_EQ(events[k].first, expected[k].first) << "gap " << body << ", contact " << k;
      ASSERT_TRUE(events[k].second == expected[k].second) << "gap " << body << ", time of contact " << k;
    }
  }
}

// Of all gaps the chosen one is first by (exact time, position), whatever the keys can tell.
template <class T>
void expect_every_choice_right(const Scene<T>& bodies, const Inelastic<T>& law, const T& end,
                               std::uint64_t least_contacts) {
  auto run = gap_run(bodies, law);
  const auto& chain = run.chain();
  std::uint64_t wrong = 0;
  run.advance(end, [&](const Contact<T>& contact) {
    const Slot chosen = static_cast<Slot>(contact.left - chain.body(0));
    const T time = chain.due(chosen);
    for (Slot s = chain.first(); s <= chain.last(); ++s) {
      if (s == chosen || !(chain.closing(s) > T(0))) continue;
      const T due = chain.due(s);
      wrong += due < time || (due == time && s < chosen);
    }
  });
  EXPECT_EQ(wrong, 0U);
  EXPECT_GE(run.counts().contacts, least_contacts);
  EXPECT_GT(run.counts().close_calls, 0U);
}

TYPED_TEST(FilteredQueue, MixedVelocities) {
  using T = typename TypeParam::Scalar;
  expect_same_contacts(rmix<T>(32), Inelastic<T>(T(15) / T(16), T(0)), T(1000), 188);
}

TYPED_TEST(FilteredQueue, Shock) {
  using T = typename TypeParam::Scalar;
  expect_same_contacts(rshock<T>(200), Inelastic<T>(from_text<T>(".9"), from_text<T>("1e-3")), T(66), 5000);
}

TYPED_TEST(FilteredQueue, ThreeBodyCollapse) {
  using T = typename TypeParam::Scalar;
  for (const char* restitution : {".05", ".01", ".0625"})
    expect_same_contacts(list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}),
                         Inelastic<T>(from_text<T>(restitution), T(0)), T(10), 100, stop_below(from_text<T>("1e-280")));
}

// At eps = .4 seven bodies are enough: 2/(1 - (4/pi) atan sqrt eps) = 7.1.
TYPED_TEST(FilteredQueue, ManyBodyCollapse) {
  using T = typename TypeParam::Scalar;
  expect_same_contacts(rshock<T>(12), Inelastic<T>(from_text<T>(".4"), T(0)), T(100), 100,
                       stop_below(from_text<T>("1e-200")));
}

template <class T> Scene<T> perfect_lattice() {
  return std::make_shared<Rows<T>>(
      symmetric_rows<T>(40, T(T(1) / T(2)), T(1), [](BodyIndex) { return std::int64_t{0}; }));
}

// Bodies on integers with a few integer velocities: times are small rationals, equal ones abound.
template <class T> Scene<T> integers() {
  std::vector<T> x, v;
  for (BodyIndex i = 0; i < 60; ++i) {
    x.push_back(T(i));
    v.push_back(T(bits_of(i, 7, 3) - 1));
  }
  return list(std::move(x), std::move(v));
}

// Elastic rows of a perfect lattice: all pairs of a generation meet at one time, exactly representable.
TYPED_TEST(FilteredQueue, ElasticLattice) {
  using T = typename TypeParam::Scalar;
  expect_same_contacts(perfect_lattice<T>(), Inelastic<T>(T(1), T(0)), T(100), 20 * 21 / 2);
}

// Inelastic ones: mirror symmetry makes pairs of equal times, and triple collisions that rounding decides.
TYPED_TEST(FilteredQueue, InelasticLattice) {
  using T = typename TypeParam::Scalar;
  expect_same_contacts(perfect_lattice<T>(), Inelastic<T>(T(15) / T(16), from_text<T>("1e-3")), T(30), 100);
}

TYPED_TEST(FilteredQueue, IntegerPlacesAndVelocities) {
  using T = typename TypeParam::Scalar;
  expect_every_choice_right(integers<T>(), Inelastic<T>(T(1), T(0)), T(200), 200);
  expect_every_choice_right(integers<T>(), Inelastic<T>(T(3) / T(4), from_text<T>("1e-3")), T(10), 100);
  expect_every_choice_right(perfect_lattice<T>(), Inelastic<T>(T(1), T(0)), T(100), 20 * 21 / 2);
  expect_every_choice_right(perfect_lattice<T>(), Inelastic<T>(T(15) / T(16), from_text<T>("1e-3")), T(30), 100);
}

template <class T>
std::uint64_t expect_index_bits_change_no_bit(const Scene<T>& bodies, const Inelastic<T>& law, const T& step,
                                              int steps) {
  auto run = gap_run(bodies, law, {}, T(0), {.least_queue_bits = 3});
  auto run13 = gap_run(bodies, law, {}, T(0), {.least_queue_bits = 13});
  auto run20 = gap_run(bodies, law, {}, T(0), {.least_queue_bits = 20});
  T t(0);
  for (int k = 0; k < steps; ++k) {
    t += step;
    for (auto* other : {&run, &run13, &run20}) EXPECT_EQ(other->advance(t), Status::reached);
    for (const auto* other : {&run13, &run20}) {
      EXPECT_TRUE(same_contacts(run.counts(), other->counts())) << to_double(t);
      EXPECT_TRUE(run.energy_lost() == other->energy_lost()) << to_double(t);
      EXPECT_TRUE(identical(configuration_at(run, t), configuration_at(*other, t))) << to_double(t);
    }
  }
  return run20.counts().close_calls;
}

TYPED_TEST(FilteredQueue, IndexBitsChangeNoBit) {
  using T = typename TypeParam::Scalar;
  expect_index_bits_change_no_bit(rshock<T>(200), Inelastic<T>(from_text<T>(".9"), from_text<T>("1e-3")), T(14), 5);
  expect_index_bits_change_no_bit(rmix<T>(32), Inelastic<T>(T(15) / T(16), T(0)), T(200), 5);
}

TYPED_TEST(FilteredQueue, IndexBitsChangeNoBitWhereTimesAreEqual) {
  using T = typename TypeParam::Scalar;
  EXPECT_GT(expect_index_bits_change_no_bit(perfect_lattice<T>(), Inelastic<T>(T(15) / T(16), T(0)), T(2), 8), 0U);
  EXPECT_GT(expect_index_bits_change_no_bit(integers<T>(), Inelastic<T>(T(1), T(0)), T(2), 20), 0U);
}

}  // namespace filtered_queue_test
