#include "cradle/tools/ensemble/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/ensemble/replica_run.hpp"
#include "cradle/tools/support/spelling.hpp"

namespace cradle::tools {

namespace {

std::vector<JobRange> jobs_left(const EnsembleStore& store, ReplicaRange wanted) {
  std::vector<JobRange> jobs;
  for (std::size_t point = 0; point < store.states().size(); ++point)
    for (const ReplicaRange& range : store.states()[point]->replicas().missing(wanted)) jobs.push_back({point, range});
  return jobs;
}

// A process has one number of MPFR digits at a time.
void check_digits(const Study& study) {
  for (const Study::Point& point : study.points)
    if (point.scene.run.digits != study.points.front().scene.run.digits)
      throw Error(
          {"", 0, "run.precision"}, "ensembles of different digits in one file",
          fmt::format("{} and {}", precision_name(study.points.front().scene.run), precision_name(point.scene.run)),
          "run them one after the other");
}

// The command that runs this replica alone, with the settings of its point.
std::string alone_command(const std::string& file, const std::string& group, ReplicaIndex replica) {
  const auto stem = std::filesystem::path(file).replace_extension().string();
  const std::string folder = stem == file ? file + "-scenes" : stem;
  return fmt::format("cradle export {} --to {} && cradle run {}/{}scene.toml --set initial.replica={} -o replica.h5",
                     shell_word(file), shell_word(folder), shell_word(folder), group.empty() ? "" : group + "/",
                     replica);
}

std::string failure_warning(const EnsembleStates& states, const std::string& file) {
  constexpr int shown = 5;
  std::string text, first, groups;
  int failures = 0;
  bool unproved = false;
  for (const auto& state : states) {
    const std::string& group = state->group();
    const auto failed = state->failures();
    const Scene& scene = state->scene();
    for (const auto& [replica, message] : failed) {
      if (++failures <= shown)
        text += fmt::format("{}replica {} failed: {}\n", group.empty() ? "" : group + ": ", replica, message);
      unproved =
          unproved || (message == end_row(RunEnd::exhausted).text && stops_at_collapse(scene) && !scene.run.stop_gap);
    }
    if (failed.empty()) continue;
    if (first.empty()) first = alone_command(file, group, failed.begin()->first);
    groups += fmt::format("{}/{}replicas/failed", groups.empty() ? "" : ", ", group.empty() ? "" : group + "/");
  }
  if (failures > shown) text += fmt::format("and {} more: see {} in {}\n", failures - shown, groups, file);
  if (unproved)
    text += "a collapse of more than three particles is not proved: with run.stop_gap (a gap of 1e-12, say) these "
            "replicas end there and have collapsed\n";
  if (failures > 0) text += fmt::format("the first of them again, alone: {}\n", first);
  return text;
}

// What their numbers are of.
std::string collapsed_note(const EnsembleStates& states) {
  std::uint64_t collapsed = 0;
  for (const auto& state : states) collapsed += state->outcomes()[static_cast<std::size_t>(RunEnd::collapsed)];
  if (collapsed == 0) return "";
  return fmt::format("{} replicas ended at a collapse: their energy is the one there, and means at later times are of "
                     "the others\n",
                     collapsed);
}

// What a thread of this process works with: it runs replicas in batches, which take a hundredth of a second or longer
// only if they are a single replica. A kill loses the present batch.
struct Worker {
  std::unique_ptr<ReplicaRun> runs = {};  // of the ensemble that it worked at last
  std::uint64_t batch = 1;                // replicas

  EnsembleRecord run(const EnsembleState& ensemble, const JobRange& job, Interrupt& interrupt) {
    using namespace std::chrono_literals;
    constexpr std::uint64_t most = 1 << 12;
    const auto begun = std::chrono::steady_clock::now();
    if (!runs || &runs->ensemble() != &ensemble) runs = std::make_unique<ReplicaRun>(ensemble, interrupt);
    EnsembleRecord done{.point = job.point};
    try {
      for (ReplicaIndex k = job.replicas.first; k < job.replicas.end(); ++k) {
        if (interrupt.signal() != 0) break;
        runs->add(k, done);
      }
    } catch (const ReplicaAbandoned&) {
    }
    const auto took = std::chrono::steady_clock::now() - begun;
    batch = took > 10ms ? std::max<std::uint64_t>(batch / 2, 1) : took < 4ms ? std::min(2 * batch, most) : batch;
    return done;
  }
};

// Runs jobs on all threads of this process and puts the results into the store.
void work(EnsembleStore& store, const EnsembleOptions& options, const Processes& processes, const NextJob& next,
          const std::function<void(std::uint64_t replicas)>& finished) {
  std::mutex mutex;
  std::vector<std::unique_ptr<Worker>> idle;
  struct Batch {
    std::shared_ptr<Worker> by;
    JobRange job;
  };
  const auto worker = [&] {
    const std::scoped_lock lock(mutex);
    std::unique_ptr<Worker> free = idle.empty() ? std::make_unique<Worker>() : std::move(idle.back());
    if (!idle.empty()) idle.pop_back();
    return std::shared_ptr<Worker>(free.release(), [&](Worker* again) {
      const std::scoped_lock back(mutex);
      idle.emplace_back(again);
    });
  };
  run_jobs(
      Threads(options.threads > 0 ? options.threads : processes.threads()),
      [&]() -> std::optional<Batch> {
        std::shared_ptr<Worker> by = worker();
        const auto job = next(by->batch);
        return job ? std::optional(Batch{std::move(by), *job}) : std::nullopt;
      },
      [&](const Batch& batch) {
        return batch.by->run(*store.states()[batch.job.point], batch.job, processes.interrupt());
      },
      [&](const Batch&, EnsembleRecord&& done) {
        const std::uint64_t replicas = done.rows.size();
        if (replicas > 0) store.add(std::move(done));
        finished(replicas);
      },
      [](const Batch&, const std::string& message) { throw Error(message, Exit::lost); },
      [&] { return processes.interrupt().signal() != 0; });
}

// The part of rank 0, which handles the files.
EnsembleOutcome lead(EnsembleStore& store, const EnsembleOptions& options, const std::string& file,
                     Processes& processes, const std::vector<JobRange>& jobs) {
  const std::uint64_t wanted = options.replicas.count * store.states().size(), fresh = JobQueue(jobs).left();
  ReplicaProgress progress(options.progress, wanted - fresh, wanted);
  const int signal = processes.share(
      jobs,
      [&](const NextJob& next) { work(store, options, processes, next, [&](std::uint64_t n) { progress.done(n); }); },
      [&](std::uint64_t replicas) { progress.done(replicas); });
  EnsembleOutcome end;
  end.fresh = fresh;
  if (signal == 0) {
    processes.gather([](const PutRecord&) {}, [&](std::string_view record) { store.apply(record); });
    if (fresh > 0 || !store.result_there())
      store.finish();
    else
      store.drop_journals();
    end.replicas = store.replicas();
    end.outcome = store.outcome();
    end.account = collapsed_note(store.states());
    end.warning = failure_warning(store.states(), file);
    if (!end.warning.empty()) end.status = Exit::lost;
  } else {
    store.sync();
    end.status = status_of_signal(signal);
  }
  return end;
}

EnsembleOutcome follow(EnsembleStore& store, const EnsembleOptions& options, Processes& processes) {
  const int signal = processes.share(
      {}, [&](const NextJob& next) { work(store, options, processes, next, [](std::uint64_t) {}); }, {});
  if (signal == 0)
    processes.gather([&](const PutRecord& put) { store.put_records(put); }, [](std::string_view) {});
  else
    store.sync();
  return {};
}

}  // namespace

EnsembleOutcome run_study(const Study& study, const EnsembleOptions& options, const std::string& file,
                          Processes& processes) {
  std::optional<EnsembleStore> store;
  std::string account;
  std::vector<JobRange> jobs;  // of rank 0, which gives them to all
  const unsigned rank = processes.rank();
  bool ready = processes.together([&] {
    check_digits(study);
    store.emplace(study, file);
    if (rank != 0) return;
    account = store->load(options.force);
    jobs = jobs_left(*store, options.replicas);
  });
  ready = ready && processes.together([&] {  // now that rank 0 has read and removed the journals of an earlier job
    if (rank != 0 || !jobs.empty()) store->start_journal(rank, options.replicas);
  });
  if (!ready) return {};
  processes.interrupt().heed();
  if (rank != 0) return follow(*store, options, processes);
  EnsembleOutcome end = lead(*store, options, file, processes, jobs);
  end.account.insert(0, account);
  return end;
}

}  // namespace cradle::tools
