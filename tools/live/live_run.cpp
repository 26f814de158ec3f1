#include "cradle/tools/live/live_run.hpp"

#include <stdexcept>

#include "cradle/core/base/state.hpp"
#include "cradle/core/parallel/workers.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/checkpoint.hpp"
#include "cradle/tools/store/run_journal.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tools {

// The kind of these checkpoints (JournalHeader::kind).
constexpr const char* live_kind = "simulation";

void LiveRun::PolledMemory::check_clock() {
  const auto now = std::chrono::steady_clock::now();
  if (!poll_ || now - polled_ < std::chrono::milliseconds(50)) return;
  polled_ = now;
  poll_();
}

void LiveRun::begin(const LiveOptions& options) {
  if (options.begins) options.begins(scene_);
  Workers workers;
  if (threads_ > 1)
    workers = {threads_, [this](std::size_t jobs, const Workers::Work& work) { for_each(*executor_, jobs, work); }};
  run_ = begin_run(scene_, {Progress::Show::never, nullptr, nullptr, workers, true, options.restitution}, sink_);
}

LiveRun::LiveRun(const Scene& scene, const LiveOptions& options)
    : scene_(scene), sink_(options.poll), own_law_(options.restitution), threads_(thread_count(options.threads)) {
  begin(options);
}

LiveRun::LiveRun(const std::string& checkpoint, const LiveOptions& options)
    : sink_(options.poll), own_law_(options.restitution), threads_(thread_count(options.threads)) {
  StateReader from(checkpoint);
  const JournalHeader& header = from.header().run;
  if (header.kind != live_kind)
    throw Error({checkpoint, 0, ""}, "a checkpoint of another command", header.kind, "continue it with `cradle resume`",
                Exit::io);
  scene_ = scene_of(header, checkpoint);
  begin(options);
  std::vector<Group> rows;
  try {
    cradle::load(from, rows);
  } catch (const std::invalid_argument& error) {
    throw Error({checkpoint, 0, ""}, "a checkpoint that cannot be continued", error.what(),
                "use the program that wrote it, or begin anew", Exit::io);
  }
  for (Group& table : rows) sink_.add(std::move(table));
  run_->load(from);
}

template <class F> void LiveRun::with_threads(const F& f) {
  struct AtEnd {
    ~AtEnd() { executor.reset(); }
    std::optional<Threads>& executor;
  } const at_end{executor_};
  if (threads_ > 1) executor_.emplace(threads_);
  f();
}

void LiveRun::advance(const Decimal& until) {
  with_threads([&] { run_->advance(until); });
}

std::uint64_t LiveRun::step(std::uint64_t n, const Decimal& until) {
  with_threads([&] { n = run_->step(n, until); });
  return n;
}

void LiveRun::require_own_law(const char* what) const {
  if (own_law_)
    throw Error(scene_.place("restitution"), std::string("a function cannot be ") + what, "",
                "collect its numbers in Python (every, on_collision)");
}

void LiveRun::save(const std::string& path) {
  require_own_law("saved");
  const FileClaim claim(path);
  StateWriter to(
      path,
      {{live_kind, 0, effective_toml(scene_), scene_.name}, 0, 0, 0, run_->time().value, run_->counts().collisions});
  run_->put_rows();
  cradle::save(to, sink_.tables());
  run_->save(to);
  to.finish();
}

Result LiveRun::result() const {
  if (run_->over()->end == RunEnd::interrupted || !without_collisions(scene_)) return sink_.result();
  MemorySink direct(Tables::for_file);
  run_scene(scene_, {Progress::Show::never}, direct);
  return std::move(direct).result();
}

void LiveRun::write(const std::string& path, Force force) const {
  require_own_law("written");
  if (run_->over() == nullptr)
    throw Error({scene_.name, 0, ""}, "not at its end", "t = " + run_->time().text(),
                "advance to run.until = " + scene_.run.until.text + " first, stop the run here, or save a checkpoint");
  const FileClaim claim(path);
  check_overwrite(path, "run", &scene_, force);
  write_or_keep(result(), path);
}

}  // namespace cradle::tools
