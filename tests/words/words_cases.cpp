// Words of collapse: the ends that are known in closed form, existence as rational arithmetic decides it, and what the
// proofs must refuse. Also run with errors planted in core/words/, each of which a case here must find.
#include <gtest/gtest.h>

#include <random>

#include "cradle/core/words/ranges.hpp"
#include "cradle/precision/ball.hpp"
#include "cradle/tests/words/rational_words.hpp"

namespace cradle::tests::words_cases {

using namespace words;
using Real = Mpfr<8>;
using Exact = Ball<Real>;

constexpr std::size_t points = 1999;
constexpr long double tolerance = 1e-11L;

Real number(const std::string& text) { return from_text<Real>(text); }

class Words : public testing::Test {
 protected:
  Words() { MpfrPrecision::set_bits(MpfrPrecision::bits_for(120)); }

  template <class N> static words::Shares<N> equal(std::size_t particles) {
    return shares(std::vector<N>(particles, N(1)), {});
  }
  static Prover<Exact, Real> prover(const Word& word, std::size_t particles, bool mirrored = false) {
    return {word, equal<Real>(particles), equal<Exact>(particles), mirrored};
  }
  static std::vector<Range<Real>> ranges_of(const std::string& text, std::size_t particles) {
    System<long double> quick(read_word(text, particles - 1), equal<long double>(particles));
    const auto runs = scan(quick, points, tolerance);
    quick = in_order_of_time(quick, 0.05L, tolerance, Begin::longest_or_half);
    return ranges(prover(quick.word, particles, quick.period.mirrored), quick, runs, points, tolerance,
                  number("1e-32"));
  }
};

Real root(int of) { return sqrt(Real(of)); }

// However small the roots are, which the bound that the search begins with is not.
TEST_F(Words, TheLargestModulusHasAllDigitsOfADouble) {
  const Real small = number("3e-9"), smaller = number("-1e-9");
  EXPECT_EQ(to_double(largest_modulus(Polynomial<Real>{small * smaller, -(small + smaller), Real(1)})), 3e-9);
  EXPECT_EQ(to_double(largest_modulus(Polynomial<Real>{small * small, Real(0), Real(1)})), 3e-9) << "+-3e-9 i";
}

TEST_F(Words, HaveTheEndsThatAreKnownProvedTo30Digits) {
  for (const auto& [word, particles, end] : {std::tuple{"ab", 3U, Real(7) - Real(4) * root(3)},
                                             {"acb", 4U, Real(3) - Real(2) * root(2)},
                                             {"ababcb", 4U, Real(5) - Real(2) * root(6)}}) {
    SCOPED_TRACE(word);
    const auto found = ranges_of(word, particles);
    ASSERT_EQ(found.size(), 1U);
    const Range<Real>& range = found.front();
    EXPECT_TRUE(range.high_ends);
    EXPECT_LT(magnitude(Real(range.high.at - end)), number("1e-60"));
    // Existence is proved from 1e-32 on and up to 1e-32 below the end.
    EXPECT_EQ(range.low.is, words::End<Real>::Is::zero);
    EXPECT_TRUE(range.low_ends);
    EXPECT_LT(end - range.proved_high, number("1.1e-32"));
  }
}

// The characteristic polynomial of half the word `abcb` and the mirror image has a double root where its discriminant
// is 0, which has this factor.
TEST_F(Words, AbcbEndsAtARootOfAPolynomialOfDegree6) {
  const auto found = ranges_of("abcb", 4);
  ASSERT_EQ(found.size(), 1U);
  const Range<Real>& range = found.front();
  EXPECT_TRUE(range.high_ends);
  EXPECT_EQ(range.high.is, words::End<Real>::Is::meeting);
  EXPECT_LT(range.high.at - range.proved_high, number("1.1e-32"));
  EXPECT_NEAR(to_double(range.high.at), 0.191659578393, 1e-12) << "as the prototype found it";
  Polynomial<Exact> p;
  for (const int c : {17, -138, 831, -3148, 831, -138, 17}) p.push_back(Exact(c));
  EXPECT_TRUE(is_positive(value_at(p, Exact(Real(range.high.at - number("1e-32")), 0))));
  EXPECT_TRUE(is_negative(value_at(p, Exact(Real(range.high.at + number("1e-32")), 0))));
}

TEST_F(Words, ExistAsRationalArithmeticDecides) {
  std::mt19937_64 random(31);
  const auto below = [&](std::uint64_t n) { return random() % n; };
  int yes = 0, no = 0;
  while (yes + no < 200) {
    const std::size_t particles = 3 + below(3), gaps = particles - 1;
    Word word(particles == 3 ? 2 : 3 + below(particles == 4 ? 6 : 5));
    for (std::size_t& letter : word) letter = below(gaps);
    try {
      require_word(word, gaps);
    } catch (const BadWord&) {
      continue;
    }
    // Sometimes near the ends that equal masses have, and masses from 1 to 3.
    const auto thousandths = static_cast<std::int64_t>(1 + below(particles == 3 ? 120 : 240));
    std::vector<test::Rational> masses;
    std::vector<Real> in_real;
    std::vector<Exact> in_balls;
    const bool equal_masses = below(2) == 0;
    for (std::size_t i = 0; i < particles; ++i) {
      const auto mass = static_cast<std::int64_t>(equal_masses ? 1 : 1 + below(3));
      masses.emplace_back(mass), in_real.emplace_back(mass), in_balls.emplace_back(mass);
    }
    SCOPED_TRACE(text_of(word) + " at " + std::to_string(thousandths) + "/1000, " + std::to_string(particles) +
                 " particles, case " + std::to_string(yes + no));
    bool exactly = false;
    ASSERT_NO_THROW(exactly = test::exists_rationally(word, masses, test::Rational(thousandths, 1000)));
    const Prover<Exact, Real> here(word, shares(in_real, {}), shares(in_balls, {}));
    const Exact ball = Exact(thousandths) / Exact(1000);
    BestState<Real> found = find(here.system, ball.middle(), Real(0));
    ASSERT_EQ(found.verdict == Verdict::exists, exactly);
    // What exists is proved at this restitution. Slowly: what is out of the order of time loses digits.
    ASSERT_TRUE(!exactly || here.holds(ball, found.pairs, number("1e-100")));
    ++(exactly ? yes : no);
  }
  EXPECT_GT(yes, 40);
  EXPECT_GT(no, 40);
}

// The half of a word with its mirror image gives what the whole word gives.
TEST_F(Words, AreTheSameByHalves) {
  for (const char* text : {"ab", "abcb"}) {
    const std::size_t particles = std::string(text) == "ab" ? 3 : 4;
    const Word word = read_word(text, particles - 1);
    const auto whole = prover(word, particles), half = prover(word, particles, true);
    const Real r = number("0.06");
    const auto a = find(whole.system, r, Real(0)), b = find(half.system, r, Real(0));
    ASSERT_EQ(a.verdict, Verdict::exists);
    ASSERT_EQ(b.verdict, Verdict::exists);
    const auto first = state_of(whole.system, a.pairs), second = state_of(half.system, b.pairs);
    EXPECT_LT(magnitude(Real(first.lambda - second.lambda)), number("1e-100"));
    EXPECT_LT(magnitude(Real(first.growth / second.growth - Real(1))), number("1e-100"));
    for (std::size_t i = 0; i < first.g.size(); ++i)
      EXPECT_LT(magnitude(Real(first.g[i] * second.g[word.front()] - second.g[i] * first.g[word.front()])),
                number("1e-100"));
    Pairs<Real> near = b.pairs;
    EXPECT_TRUE(half.holds(Exact(r, 0), near, number("1e-100")));
  }
}

// The collisions of the state's own motion, particle by particle, in the order in which gaps close.
TEST_F(Words, HappenAsTheyAreWritten) {
  for (const char* text : {"acb", "abcb", "ababcb", "ababcbc"}) {
    const Word word = read_word(text, 3);
    System<Real> system(word, equal<Real>(4));
    const Real r = number("0.07");
    const BestState<Real> found = find(system, r, Real(0));
    ASSERT_EQ(found.verdict, Verdict::exists) << text;
    const Start<Real> start = start_of(system, r, found.pairs);
    std::vector<Real> g = start.gaps, w = start.speeds;
    Real elapsed(0);
    Word made;
    for (std::size_t k = 0; k < 3 * word.size(); ++k) {
      std::size_t next = g.size();
      Real time(0);
      for (std::size_t i = 0; i < g.size(); ++i) {
        ASSERT_FALSE(g[i] < number("-1e-90"));
        if (!is_positive(w[i])) continue;
        const Real until = g[i] / w[i];
        if (next == g.size() || until < time) next = i, time = until;
      }
      ASSERT_LT(next, g.size());
      for (std::size_t i = 0; i < g.size(); ++i) g[i] -= w[i] * time;
      const Real push = (Real(1) + r) * w[next] / Real(2);
      if (next > 0) w[next - 1] += push;
      if (next + 1 < w.size()) w[next + 1] += push;
      w[next] = -r * w[next];
      g[next] = Real(0);
      elapsed += time;
      made.push_back(next);
    }
    Word thrice = word;
    thrice.insert(thrice.end(), word.begin(), word.end());
    thrice.insert(thrice.end(), word.begin(), word.end());
    EXPECT_EQ(sorted(made), sorted(thrice)) << text_of(made);
    EXPECT_LT(elapsed, start.collapse);
  }
}

// Nothing is proved where it is not so: beyond an end, on a ball that reaches beyond it, for a matrix that may have no
// real eigenvalues.
TEST_F(Words, AreNotProvedWhereTheyDoNotExist) {
  const auto three = prover(read_word("ab", 2), 3);
  Pairs<Real> near = find(three.system, number("0.06"), Real(0)).pairs;
  for (const auto& [low, high] : {std::pair("0.06", "0.073"), std::pair("0.072", "0.0721"), std::pair("0.2", "0.3")}) {
    Pairs<Real> copy = near;
    EXPECT_FALSE(three.holds(between<Exact>(number(low), number(high)), copy, number("1e-10"))) << low;
  }
  Matrix<Exact> any(2);
  any(0, 0) = any(1, 1) = Exact(1);
  any(0, 1) = Exact(1);
  any(1, 0) = Exact(Real(0), 0.5L);  // eigenvalues 1 +- sqrt of what may be negative
  Matrix<Real> middle(2);
  middle(0, 0) = middle(1, 1) = middle(0, 1) = Real(1);
  middle(1, 0) = number("0.25");
  EXPECT_FALSE(enclosed(any, middle, eigenpair(std::vector<Real>{Real(1), number("0.5")}, number("1.5"))).has_value());
}

// A period must be longer than the next one, or there is no collapse.
TEST_F(Words, NeedPeriodsThatBecomeShorter) {
  const System<Real> system(read_word("ab", 2), equal<Real>(3));
  const Pairs<Real> pairs = find(system, number("0.05"), Real(0)).pairs;
  State<Real> state = state_of(system, pairs);
  const auto course_of = course(system, number("0.05"), state);
  const auto least = [&] {
    Real found(1);
    for (const auto& margin : margins(system.word, system.conditions, course_of, state))
      if (margin.value < found) found = margin.value;
    return found;
  };
  EXPECT_TRUE(is_positive(least()));
  state.growth = number("0.9") / state.lambda;
  EXPECT_TRUE(is_negative(least()));
}

// The same state with all signs changed has collisions at the same times, of gaps below 0 that open.
TEST_F(Words, NeedGapsThatClose) {
  const System<Real> system(read_word("ababcb", 3), equal<Real>(4));
  const Real r = number("0.05");
  State<Real> state = state_of(system, find(system, r, Real(0)).pairs);
  const auto negative = [&] {
    std::size_t count = 0;
    for (const auto& margin : margins(system.word, system.conditions, course(system, r, state), state))
      count += is_negative(margin.value);
    return count;
  };
  EXPECT_EQ(negative(), 0U);
  negate(state.w), negate(state.g);
  EXPECT_EQ(negative(), 6U) << "one for each closing speed";
}

TEST_F(Words, AreStableForThreeParticlesAndNotForFour) {
  const auto at = number("0.05");
  const auto three = prover(read_word("ab", 2), 3);
  const auto stable = stability(three, at, find(three.system, at, Real(0)).pairs);
  EXPECT_EQ(stable.within, Within::yes);
  const auto four = prover(read_word("ababcb", 3), 4);
  for (const auto& [r, factor] : {std::pair("0.09", 107.0), std::pair("0.1", 30.0), std::pair("0.101", 26.0)}) {
    const auto unstable = stability(four, number(r), find(four.system, number(r), Real(0)).pairs);
    EXPECT_EQ(unstable.within, Within::no) << r;
    EXPECT_NEAR(to_double(unstable.factor), factor, 1) << r;  // as measured from runs that leave the word
  }
}

}  // namespace cradle::tests::words_cases
