#include "cradle/tools/certify/replicas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "cradle/tools/ensemble/layout.hpp"
#include "cradle/tools/support/threads.hpp"

namespace cradle::tools {

namespace {

// What an ensemble keeps of a replica: its row, and its energies in the middle of their bounds.
struct Kept {
  CertifiedReplica row;
  std::vector<double> times, energies;
};

Kept kept(std::uint64_t index, const Certified& run) {
  const Certificate& c = run.certificate;
  Kept kept{{index, run.proved(), c.digits, c.contacts, {0, 0}, run.proved() ? "" : doubt_text(*c.doubt)}, {}, {}};
  if (!c.samples.empty()) kept.row.energy = c.samples.back().energy.doubles;
  for (const CertainSample& s : c.samples) {
    if (!s.of_series) continue;
    kept.times.push_back(s.time);
    kept.energies.push_back(s.energy.doubles.low + (s.energy.doubles.high - s.energy.doubles.low) / 2);
  }
  return kept;
}

}  // namespace

CertifiedReplicas certify_replicas(const Scene& scene, std::uint64_t count, unsigned threads,
                                   const CertifyOptions& options) {
  check_ensemble(scene);
  std::vector<Kept> all(count);
  const auto interrupted = [&] { return options.interrupt != nullptr && options.interrupt->signal() != 0; };
  const auto prove = [&](std::uint64_t index, const std::vector<unsigned>& digits) {
    return kept(index, certify(replica_scene(scene, index), {digits, Progress::Show::never, options.interrupt}));
  };
  ReplicaQueue queue({{0, count}});
  run_jobs(
      Threads(threads), [&] { return queue(); },
      [&](std::uint64_t k) {
        try {
          return prove(k, {options.digits.front()});
        } catch (const Error&) {
          if (interrupted()) throw ReplicaAbandoned();
          throw;
        }
      },
      [&](std::uint64_t k, Kept replica) { all[k] = std::move(replica); },
      [](std::uint64_t k, const std::string& message) {
        throw Error(fmt::format("replica {}: {}", k, message), Exit::lost);
      },
      interrupted);
  if (interrupted())
    throw Error({}, "interrupted", "", "run it again; nothing is kept of proofs that did not finish",
                status_of_signal(options.interrupt->signal()));
  const std::vector<unsigned> more(options.digits.begin() + 1, options.digits.end());
  for (Kept& replica : all)
    if (!replica.row.proved && !more.empty()) replica = prove(replica.row.index, more);

  CertifiedReplicas result{scene, {}, {}, {}};
  Ensemble energies;
  for (std::uint64_t k = 0; k < count; ++k) {
    result.replicas.push_back(all[k].row);
    if (!all[k].row.proved) continue;
    if (result.times.empty()) result.times = all[k].times;
    if (all[k].times == result.times) energies.add(k, std::move(all[k].energies));
  }
  if (!result.times.empty()) result.energy = energies.statistics();
  return result;
}

std::string replicas_text(const CertifiedReplicas& run) {
  const auto proved = static_cast<std::uint64_t>(
      std::count_if(run.replicas.begin(), run.replicas.end(), [](const auto& r) { return r.proved; }));
  std::uint64_t contacts = 0;
  std::string text;
  for (const CertifiedReplica& r : run.replicas) {
    contacts += r.contacts;
    if (!r.proved) text += fmt::format("replica {}: undecided {}\n", r.index, r.doubt);
  }
  text += fmt::format("proved: {} of {} replicas, {} contacts\n", proved, run.replicas.size(), contacts);
  if (!run.times.empty())
    text += fmt::format("  energy at t = {}: {:.12g} +- {:.2g} (mean of those proved, and its standard error)\n",
                        run.times.back(), run.energy.mean.back(), run.energy.standard_error(run.times.size() - 1));
  return text;
}

Result replicas_result(const CertifiedReplicas& run) {
  std::vector<std::uint64_t> index, proved, digits, contacts;
  std::vector<double> low, high, sem;
  for (const CertifiedReplica& r : run.replicas) {
    index.push_back(r.index), proved.push_back(r.proved), digits.push_back(r.digits), contacts.push_back(r.contacts);
    low.push_back(r.energy.low), high.push_back(r.energy.high);
  }
  for (std::size_t k = 0; k < run.times.size(); ++k) sem.push_back(run.energy.standard_error(k));
  Result result;
  result.attributes = provenance(run.scene, precision_name(run.scene.run), "replicas with proofs");
  const std::uint64_t all = std::accumulate(proved.begin(), proved.end(), std::uint64_t{0});
  result.groups.push_back({"ensemble", {{"replicas", std::uint64_t{run.replicas.size()}}, {"proved", all}}, {}});
  result.groups.push_back({"ensemble/series", {}, {{"time", "t", "of the sample", run.times}}});
  const std::string unit = "m l^2/t^2", of = " over the replicas that are proved";
  result.groups.push_back({"ensemble/series/energy",
                           {},
                           {{"mean", unit, "kinetic energy, mean" + of, run.energy.mean},
                            {"sem", unit, "standard error of the mean", sem},
                            {"min", unit, "least" + of, run.energy.least},
                            {"max", unit, "greatest" + of, run.energy.greatest}}});
  result.groups.push_back({"replicas",
                           {},
                           {{"index", "1", "of the replica", index},
                            {"proved", "1", "1: to the end; 0: undecided", proved},
                            {"digits", "1", "of the proof", digits},
                            {"contacts", "1", "proved", contacts},
                            {"energy_low", unit, "lower bound of the energy at the last sample that is proved", low},
                            {"energy_high", unit, "upper bound of it", high}}});
  result.groups.back().columns.front().names = true;
  return result;
}

}  // namespace cradle::tools
