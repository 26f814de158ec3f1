#include "cradle/tools/proof/trust.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "cradle/core/base/real.hpp"
#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/core/observe/trace.hpp"
#include "cradle/precision/bin_float.hpp"
#include "cradle/precision/double_double.hpp"
#include "cradle/tools/proof/certify.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

namespace {

// The number of digits to which numbers of this type are compared: as many as it holds, 100 at most.
double digits_held(const Run& run) {
  constexpr double most = 100, per_bit = 0.30102999566398120;
  if (run.precision == Precision::double_) return std::numeric_limits<double>::digits * per_bit;
  if (run.precision == Precision::double_double) return std::numeric_limits<double_double>::digits * per_bit;
  return std::min(static_cast<double>(run.digits), most);
}

// One sample of a run that is compared with others: what they must agree in.
struct TraceSample {
  double time = 0;
  std::uint64_t digest = 0;  // of the collisions so far, see core/observe/trace.hpp
  std::uint64_t collisions = 0, merges = 0;
  std::string energy, front;
  bool at_collision = false, open = false;  // open: on which side of it a collision falls, in a proof
};

class TraceObserver final : public RunObserver {
 public:
  void collision(ParticleIndex left, ParticleIndex right, double) override {
    trace_.collision(left, right);
    const std::pair now(left, right);
    repeats_ = repeats_ || now == last_;
    if (std::ranges::find(places_, now) == places_.end() && places_.size() < 3) places_.push_back(now);
    last_ = now;
  }
  void sample(const RunSample& sample) override {
    const SampledState& now = sample.state;
    if (sample.of_series || sample.at_collision)
      samples.push_back({sample.time.meant.value, trace_.digest(), now.counts.collisions, now.counts.merges,
                         now.energy.text(), now.front_right ? now.front_right->text() : "", sample.at_collision});
  }
  // Whether the sequence says more than the number of collisions: not at one place (a ball), nor where two take turns.
  bool has_an_order() const { return places_.size() > 2 || (places_.size() == 2 && repeats_); }
  std::vector<TraceSample> samples;

 private:
  Trace trace_;
  std::vector<std::pair<ParticleIndex, ParticleIndex>> places_;  // the first three
  std::pair<ParticleIndex, ParticleIndex> last_{-1, -1};
  bool repeats_ = false;  // a place was next to itself
};

struct Traced {
  Scene scene;
  RunOutcome outcome;
  std::vector<TraceSample> trace;
  bool has_an_order;
  double seconds;
};

Scene at_digits(Scene scene, unsigned digits, Coordinates coordinates) {
  scene.run.precision = digits == 16 ? Precision::double_ : digits == 31 ? Precision::double_double : Precision::mpfr;
  scene.run.digits = scene.run.precision == Precision::mpfr ? digits : 0;
  scene.run.coordinates = coordinates;
  return without_tables(std::move(scene));
}

Traced traced(const Scene& scene, const TrustOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  TraceObserver observer;
  const Threads threads(options.threads);
  RunOutcome outcome = run_scene(scene, {options.progress, &observer, options.interrupt, workers(threads)});
  if (outcome.end == RunEnd::interrupted)
    throw Error({}, "interrupted", "", "run it again; nothing is kept of comparisons that did not finish",
                status_of_signal(options.interrupt->signal()));
  return {scene, std::move(outcome), std::move(observer.samples), observer.has_an_order(),
          std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count()};
}

// The number that a run had. Its text is the shortest that only this number of its type is written as: of a double,
// whose 6249.505 is 6249.5050000000001..., not the number itself.
bin_float value(const std::string& text, const Run& run) {
  return run.precision == Precision::double_ ? bin_float(from_text<double>(text)) : from_text<bin_float>(text);
}

// Decimal digits that numbers of two runs share: -log10 of their difference against their size or, where that is
// given, `scale`; no more than either type has. NaN if neither has the number.
double shared_digits(const std::string& a, const Run& of_a, const std::string& b, const Run& of_b,
                     const std::string& scale = "0") {
  const double most = std::min(digits_held(of_a), digits_held(of_b));
  if (a.empty() || b.empty()) return a.empty() && b.empty() ? std::nan("") : 0;
  const bin_float x = value(a, of_a), y = value(b, of_b);
  const bin_float size = std::max({magnitude(x), magnitude(y), magnitude(value(scale, of_b))});
  const bin_float apart = magnitude(bin_float(x - y));
  if (apart == 0) return most;
  return std::clamp(-static_cast<double>(log10(bin_float(apart / size))), 0.0, most);
}

// Number of samples before the first one that does not agree.
template <class Same> std::size_t agreeing(std::size_t samples, Same same) {
  std::size_t end = 0;
  while (end < samples && same(end)) ++end;
  return end;
}

Trusted compare(const Traced& run, const Traced& reference) {
  const auto &a = run.trace, &b = reference.trace;
  Trusted trusted;
  trusted.precision = precision_name(run.scene.run);
  trusted.coordinates = run.scene.run.coordinates == Coordinates::gaps ? "gaps" : "absolute";
  trusted.seconds = run.seconds, trusted.outcome = end_row(run.outcome.end).text;
  const std::size_t samples = std::min(a.size(), b.size());
  const auto in_order = [&](std::size_t k) { return a[k].digest == b[k].digest; };
  const bool ordered = run.has_an_order || reference.has_an_order;
  std::size_t same = ordered ? samples : agreeing(samples, in_order);
  // If later all collisions so far have the same order, that was right; numbers may be the same again by chance.
  while (ordered && same > 0 && !in_order(same - 1)) --same;
  const std::size_t counted = agreeing(
      samples, [&](std::size_t k) { return a[k].collisions == b[k].collisions && a[k].merges == b[k].merges; });
  if (same > 0) trusted.time = a[same - 1].time, trusted.collisions = a[same - 1].collisions;
  if (counted > 0) trusted.counts_time = a[counted - 1].time;
  trusted.to_end = same == a.size() && a.size() == b.size();
  const auto shared = [&](const std::string& x, const std::string& y, const std::string& scale) {
    return shared_digits(x, run.scene.run, y, reference.scene.run, scale);
  };
  // States after different numbers of collisions, in which two runs have ended, are not compared.
  const auto same_moment = [&](std::size_t k) {
    return a[k].at_collision == b[k].at_collision && (!a[k].at_collision || a[k].collisions == b[k].collisions);
  };
  for (std::size_t k = 0; k < samples && same_moment(k); ++k) {
    trusted.times.push_back(a[k].time);
    trusted.energy_digits.push_back(shared(a[k].energy, b[k].energy, b[0].energy));
    trusted.front_digits.push_back(shared(a[k].front, b[k].front, "0"));
  }
  const std::size_t to_six = agreeing(trusted.times.size(), [&](std::size_t k) {
    return !(trusted.energy_digits[k] < 6) && !(trusted.front_digits[k] < 6);  // NaN: there is no front
  });
  if (to_six > 0) trusted.six_digits_time = trusted.times[to_six - 1];
  if (!run.outcome.collapse_time.empty() && !reference.outcome.collapse_time.empty())
    trusted.collapse_digits = shared(run.outcome.collapse_time, reference.outcome.collapse_time, "0");
  return trusted;
}

bool agree(const Traced& a, const Traced& b) {
  const Trusted t = compare(a, b);
  return t.to_end && *std::min_element(t.energy_digits.begin(), t.energy_digits.end()) >= 15;
}

// The sequence of collisions that is proved, as far as it is.
struct ProvedTrace {
  std::vector<TraceSample> samples;
  bool to_end = false;
};

class TracedCertifier final : public Certifier {
 public:
  TracedCertifier(std::unique_ptr<Certifier> proof, ProvedTrace& proved) : proof_(std::move(proof)), proved_(proved) {
    proved_ = {};
  }
  void collision(ParticleIndex left, ParticleIndex right, double time) override {
    proof_->collision(left, right, time);
    trace_.collision(left, right, time);
  }
  void sample(const RunSample& sample) override {
    proof_->sample(sample);
    trace_.sample(sample);
    if (proved_.samples.size() < trace_.samples.size())
      proved_.samples.push_back(trace_.samples.back()), proved_.samples.back().open = proof_->sample_is_open;
  }
  void check_beside() override { proof_->check_beside(); }
  void check_all() override { proof_->check_all(); }
  Certificate certificate() const override { return proof_->certificate(); }
  std::optional<ReportedDoubt> disagreement(Result& result) const override { return proof_->disagreement(result); }

 private:
  std::unique_ptr<Certifier> proof_;
  TraceObserver trace_;
  ProvedTrace& proved_;
};

// In long runs with no more digits than the reference has: more would take longer than all the others together.
ProvedTrace proved_trace(const Scene& scene, const Traced& reference, const TrustOptions& options) {
  const auto digits_of_reference = static_cast<unsigned>(reference.scene.run.digits);  // 0: not mpfr
  const unsigned most = reference.outcome.collisions < 1'000'000 ? 1000 : std::max(digits_of_reference, 31U);
  ProvedTrace proof;
  if (not_provable(scene)) return proof;
  CertifyOptions how{.progress = options.progress, .interrupt = options.interrupt, .threads = options.threads};
  std::erase_if(how.digits, [&](unsigned digits) { return digits > most; });
  how.make = [&](const Scene& of, unsigned digits) {
    return std::make_unique<TracedCertifier>(certifier(of, digits), proof);
  };
  proof.to_end = certify(at_digits(scene, 16, Coordinates::gaps), how).proved();
  return proof;
}

void compare_with_proof(Trusted& trusted, const Traced& run, const ProvedTrace& proof) {
  std::size_t same = agreeing(std::min(run.trace.size(), proof.samples.size()), [&](std::size_t k) {
    return proof.samples[k].open || run.trace[k].digest == proof.samples[k].digest;
  });
  trusted.proved_to_end = proof.to_end && same == run.trace.size() && same == proof.samples.size();
  while (same > 0 && proof.samples[same - 1].open) --same;
  if (same > 0) trusted.proved_time = run.trace[same - 1].time;
}

}  // namespace

std::vector<Trusted> trust(const Scene& scene, const TrustOptions& options) {
  const bool rising = options.digits.empty(), both = options.both || scene.run.coordinates == Coordinates::absolute;
  std::vector<Traced> runs;
  for (const unsigned digits : rising ? std::vector{16U, 31U, 50U, 100U, 200U, 400U} : options.digits) {
    if (both && !particles_merge(scene))
      runs.push_back(traced(at_digits(scene, digits, Coordinates::absolute), options));
    runs.push_back(traced(at_digits(scene, digits, Coordinates::gaps), options));
    const std::size_t step = both ? 2 : 1;
    if (rising && runs.size() > 2 * step && agree(runs[runs.size() - 1 - step], runs.back())) break;
  }
  const ProvedTrace proof = proved_trace(scene, runs.back(), options);
  std::vector<Trusted> table;
  for (const auto& run : runs) {
    table.push_back(compare(run, runs.back()));
    compare_with_proof(table.back(), run, proof);
  }
  return table;
}

std::string trust_table(const Scene& scene, const std::vector<Trusted>& runs) {
  const auto row = [](const auto&... cells) {
    return fmt::format("{:<18}{:<13}{:>24}{:>12}{:>14}{:>16}{:>8}{:>8}{:>8}{:>10}{:>22}\n", cells...);
  };
  std::string text = row("precision", "coordinates", "collisions right until t", "collisions", "counts until",
                         "6 digits until", "energy", "front", "t_c", "seconds", "proved");
  for (const auto& run : runs) {
    const bool reference = &run == &runs.back();
    const auto digits = [&](double d) { return reference || !(d >= 0) ? std::string("-") : fmt::format("{:.1f}", d); };
    const bool moved = !run.times.empty() && run.times.back() > scene.run.start.value;
    const auto last = [&](const std::vector<double>& d) { return digits(moved ? d.back() : -1); };
    const auto time = [](double t) { return std::isnan(t) ? std::string("-") : fmt::format("{:.8g}", t); };
    const auto proved = run.proved_to_end                         ? std::string("to the end")
                        : run.proved_time > scene.run.start.value ? "until " + time(run.proved_time)
                                                                  : "-";
    const auto upto = reference ? std::string("(reference)") : time(run.time) + (run.to_end ? " (end)" : "");
    text += row(run.precision, run.coordinates, upto, run.collisions, time(run.counts_time), time(run.six_digits_time),
                last(run.energy_digits), last(run.front_digits), digits(run.collapse_digits),
                fmt::format("{:.2f}", run.seconds), proved);
  }
  text += "\nTimes are those of samples (output.series). Right: the same sequence of collisions at every particle as "
          "the reference; collisions: how many these are.\ncounts: numbers of collisions and merges. energy, front: "
          "digits shared with the reference at the last sample of both, of those that the type has, 100 at most, from "
          "the first digit on of the energy at the start or of a greater one (k fewer if it has fallen by 10^k), or of "
          "the front (fewer where it passes zero). t_c: of the collapse time. 6 digits until: they share six.\n"
          "proved: until when these collisions are proved to be those of the exact system (cradle certify); -: none.\n";
  if (!scene.run.stop_gap && status_of_text(runs.back().outcome) == Exit::collapse)
    text +=
        "Each run ends in the collapse where its own precision decides, maybe after another number of collisions, so "
        "that the ends are not compared: with a run.stop_gap, 1e-20 say, all of them end at the same gap and "
        "can be compared up to there.\n";
  return text;
}

Result trust_result(const Scene& scene, const std::vector<Trusted>& runs) {
  Result result;
  result.attributes = provenance(scene, runs.back().precision, "comparison of precisions");
  for (const auto& run : runs) {
    Group group{fmt::format("trust/{:04}", result.groups.size()), {}, {}};
    group.attributes = {{"precision", run.precision},
                        {"coordinates", run.coordinates},
                        {"outcome", run.outcome},
                        {"collisions_right_until", run.time},
                        {"collisions_right", run.collisions},
                        {"counts_right_until", run.counts_time},
                        {"six_digits_until", run.six_digits_time},
                        {"right_to_end", std::uint64_t{run.to_end}},
                        {"proved_until", run.proved_time},
                        {"proved_to_end", std::uint64_t{run.proved_to_end}}};
    group.columns = {
        {"time", "t", "of the sample", run.times},
        {"energy_digits", "1",
         "decimal digits shared with the reference, the last run here, of those that the type has, against the "
         "energy at the start",
         run.energy_digits},
        {"front_digits", "1", "the same of the right front", run.front_digits}};
    result.groups.push_back(std::move(group));
  }
  return result;
}

}  // namespace cradle::tools
