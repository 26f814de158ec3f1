// The analysis of a word in one type of numbers, in digits.
#include <fmt/format.h>

#include <algorithm>

#include "cradle/core/words/ranges.hpp"
#include "cradle/precision/ball.hpp"
#include "cradle/precision/text.hpp"
#include "cradle/tools/words/words.hpp"

namespace cradle::tools {

using words::Condition;
using words::Verdict;
using words::Within;

namespace {

constexpr long double tolerance = 1e-11L;

template <class T> class Analyst {
  using B = Ball<T>;

 public:
  Analyst(const WordParticles& particles, const words::Word& word)
      : particles_(particles), quick_(word, shares_in<long double>(particles)),
        runs_(words::scan(quick_, word_points, tolerance)) {}

  bool any() const {
    return std::any_of(runs_.begin(), runs_.end(), [](const auto& run) { return run.verdict != Verdict::none; });
  }

  WordReport report(const std::optional<Decimal>& at) {
    WordReport report;
    report.word = report.in_order = words::text_of(quick_.word);
    for (const words::Run& run : runs_)
      if (run.verdict == Verdict::degenerate) report.degenerate = degenerate_text(run);
    const auto first =
        std::find_if(runs_.begin(), runs_.end(), [](const auto& run) { return run.verdict == Verdict::exists; });
    if (first == runs_.end()) return report;
    const long double middle = words::grid_point<long double>((first->first + first->last) / 2, word_points);
    quick_ = words::in_order_of_time(quick_, middle, tolerance,
                                     particles_.symmetric() ? words::Begin::longest_or_half : words::Begin::longest);
    report.in_order = words::text_of(quick_.word);
    report.mirrored = quick_.period.mirrored;
    const words::Prover<B, T> prover(quick_.word, shares_in<T>(particles_), shares_in<B>(particles_), report.mirrored);
    // Two digits more than are printed.
    const T radius = from_text<T>(fmt::format("1e-{}", particles_.digits + 2));
    for (const auto& range : words::ranges(prover, quick_, runs_, word_points, tolerance, radius))
      report.ranges.push_back(text_of(prover, range, radius, at));
    return report;
  }

 private:
  // What a margin says, where it is 0.
  static std::string equality_text(const words::Word& word, const std::vector<Condition>& conditions,
                                   std::size_t margin) {
    const auto collision = [&](std::size_t place) {
      return fmt::format("collision {} ({})", place + 1, static_cast<char>('a' + word[place]));
    };
    if (margin + 1 >= conditions.size())
      return margin + 1 == conditions.size() ? "closing speeds no longer shrink" : "periods no longer become shorter";
    const Condition& c = conditions[margin];
    if (c.of == Condition::Of::closing) return fmt::format("the closing speed of {} is 0", collision(c.first));
    return fmt::format("three particles meet: {}{} at the time of {}", collision(c.second),
                       c.next_period ? " of the next period" : "", collision(c.first));
  }

  std::string degenerate_text(const words::Run& run) const {
    const words::System<T> system(quick_.word, shares_in<T>(particles_));
    const T r = words::grid_point<T>((run.first + run.last) / 2, word_points), none = from_text<T>("1e-50");
    const auto found = words::find(system, r, none);
    if (found.verdict != Verdict::degenerate) return "";
    const auto margins = words::margins(system, r, found.pairs);
    for (std::size_t k = 0; k < margins.size(); ++k)
      if (!(margins[k].value > none * margins[k].scale))
        return fmt::format("at r = {:.4g} {}, to 50 digits", to_double(r),
                           equality_text(quick_.word, system.conditions, k));
    return "";
  }

  bool is_stable(long double r) const {
    const auto found = words::find(quick_, r, tolerance);
    if (found.verdict != Verdict::exists) return false;
    const auto [speeds, gaps] = words::others(quick_, r, found.pairs);
    return words::largest_modulus(speeds) < 1 && words::largest_modulus(gaps) < 1;
  }

  // Ends are bisected between the points of a grid, except for those of the range itself.
  std::vector<std::pair<double, double>> stable_ranges(double low, double high) const {
    constexpr int steps = 256;
    const auto at = [&](int k) {
      return static_cast<long double>(low) + static_cast<long double>(high - low) * (k + 0.5L) / steps;
    };
    const auto change = [&](long double yes, long double no) {
      for (int i = 0; i < 40; ++i) {
        const long double middle = (yes + no) / 2;
        (is_stable(middle) ? yes : no) = middle;
      }
      return static_cast<double>(yes);
    };
    std::vector<std::pair<double, double>> all;
    bool before = false;
    for (int k = 0; k < steps; ++k) {
      const bool here = is_stable(at(k));
      if (here && !before) all.emplace_back(k == 0 ? low : change(at(k), at(k - 1)), high);
      if (!here && before) all.back().second = change(at(k - 1), at(k));
      before = here;
    }
    return all;
  }

  WordEnd text_of(const words::System<T>& system, const words::End<T>& end, bool proved) const {
    using Is = typename words::End<T>::Is;
    WordEnd text;
    text.value = to_double(end.at);
    text.proved = proved;
    text.at = end.is == Is::zero ? "0" : cut_off(to_text(end.at), particles_.digits);
    if (end.is == Is::zero) text.reason = "no restitution is smaller";
    if (end.is == Is::meeting) text.reason = "two eigenvalues of the velocity map meet, and are complex beyond";
    if (end.is == Is::unresolved) text.reason = "not resolved";
    if (end.is == Is::equality) text.reason = equality_text(system.word, system.conditions, end.margin);
    return text;
  }

  WordRange text_of(const words::Prover<B, T>& prover, const words::Range<T>& range, const T& radius,
                    const std::optional<Decimal>& at) const {
    WordRange text;
    text.low = text_of(prover.system, range.low, range.low_ends);
    text.high = text_of(prover.system, range.high, range.high_ends);
    text.proved_from = to_text(range.proved_low), text.proved_to = to_text(range.proved_high);
    const bool to_low = !(range.low.at + radius * T(2) < range.proved_low);
    const bool to_high = !(range.proved_high < range.high.at - radius * T(2));
    text.proved = text.low.proved && text.high.proved && to_low && to_high;

    T r = range.middle;
    words::Pairs<T> pairs = range.pairs;
    if (at) {
      r = from_text<T>(at->text);
      const auto found = words::find(prover.system, r, T(0));
      if (found.verdict != Verdict::exists)
        throw Error({"", 0, "--at"}, "no such state at this restitution", at->text,
                    fmt::format("give one between {} and {}", text.low.at, text.high.at));
      pairs = found.pairs;
    }
    pairs = words::followed(prover.system, r, pairs);
    const auto state = words::state_of(prover.system, pairs);
    text.at = at ? at->text : fmt::format("{}", to_double(r));
    text.lambda = to_double(state.lambda);
    text.gamma = to_double(T(T(1) / state.growth));
    const auto stable = words::stability(prover, r, pairs);
    text.factor = to_double(stable.factor);
    text.stable = stable.within == Within::yes  ? "stable, proved"
                  : stable.within == Within::no ? "unstable, proved"
                  : stable.factor < T(1)        ? "stable"
                                                : "unstable";
    text.stable_ranges = stable_ranges(text.low.value, text.high.value);
    text.start = start_text(particles_, prover.system, r, pairs, particles_.digits + 5);
    return text;
  }

  const WordParticles& particles_;
  words::System<long double> quick_;
  std::vector<words::Run> runs_;
};

// Four times as many digits as are proved: for the smallest eigenvalues, and for steps of Newton's method.
template <class Found, class F> Found in_digits(unsigned digits, [[maybe_unused]] F f) {
#ifdef CRADLE_WITH_MPFR
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(4 * digits));
  if (Mpfr<8>::holds(4 * digits)) return f(std::type_identity<Mpfr<8>>{});
  if (Mpfr<56>::holds(4 * digits)) return f(std::type_identity<Mpfr<56>>{});
#endif
  throw Error({"", 0, "--digits"}, "no balls of so many digits in this build", fmt::format("{}", 4 * digits),
              "install libmpfr-dev (Debian's name) and build again, or give at most 250 digits");
}

}  // namespace

WordReport report_word(const WordParticles& particles, const words::Word& word, const std::optional<Decimal>& at) {
  WordReport report;
  report.word = report.in_order = words::text_of(word);
  if (particles.left_wall && particles.right_wall) return report;
  report = in_digits<WordReport>(
      particles.digits, [&]<class T>(std::type_identity<T>) { return Analyst<T>(particles, word).report(at); });
  report.word = words::text_of(word);
  return report;
}

std::vector<WordReport> search_words(const WordParticles& particles, std::size_t longest,
                                     const std::function<void(const WordReport&)>& found, std::size_t& tried) {
  if (particles.left_wall && particles.right_wall) return {};  // all gaps together are as long as they were
  return in_digits<std::vector<WordReport>>(particles.digits, [&]<class T>(std::type_identity<T>) {
    std::vector<WordReport> all;
    words::for_each_word(particles.gaps(), longest, particles.symmetric(), [&](const words::Word& word) {
      ++tried;
      Analyst<T> analyst(particles, word);
      if (!analyst.any()) return;
      all.push_back(analyst.report({}));
      all.back().word = words::text_of(word);
      found(all.back());
    });
    return all;
  });
}

}  // namespace cradle::tools
