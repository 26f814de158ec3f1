// A run that Python holds: a held run (tools/run/run.hpp) with its tables in memory, threads of its own, and
// files: checkpoints, and the result at its end.
//
// One scene is not as in `cradle run`: a sticky gas whose scene observes no collision is computed there directly at
// each output time. Here its collisions are made, which differ by rounding, and the file is computed as `cradle run`
// does.
//
// Functions of the caller come as arguments of `advance` and `step` and are only borrowed, so that Python's garbage
// collector sees all references. A call with such a function keeps the interpreter's lock, which the interpreter hands
// on while the function runs; a call without one gives it back, and takes it some times a second to see whether Ctrl-C
// was pressed. A run that is in a call refuses others: from another thread, or from a function that it has called.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/core/parallel/workers.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/store/unfinished.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tools {

namespace py = pybind11;

/// cradle.Collision, a named tuple. The module has it for as long as the interpreter lives.
inline PyTypeObject* collision_type = nullptr;

/// The result of a call, a new reference. Throws the exception of the function.
inline py::object called(py::handle function, py::object argument) {
  PyObject* const result = PyObject_CallOneArg(function.ptr(), argument.ptr());
  if (result == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(result);
}

inline void observe(py::handle function, const ObservedCollision& c) {
  const std::array values{PyLong_FromLongLong(c.left), PyLong_FromLongLong(c.right), PyFloat_FromDouble(c.time),
                          PyFloat_FromDouble(c.interval), PyFloat_FromDouble(c.closing_speed)};
  // As tuple.__new__ makes it, without arguments: one is made for every collision that is observed.
  auto tuple = py::reinterpret_steal<py::object>(collision_type->tp_alloc(collision_type, values.size()));
  if (!tuple) throw py::error_already_set();
  for (std::size_t k = 0; k < values.size(); ++k)
    PyTuple_SET_ITEM(tuple.ptr(), static_cast<Py_ssize_t>(k), values[k]);  // takes the reference
  if (std::find(values.begin(), values.end(), nullptr) != values.end()) throw py::error_already_set();
  called(function, std::move(tuple));
}

inline double restitution(py::handle function, double closing_speed) {
  const py::object result = called(function, py::float_(closing_speed));
  const double value = PyFloat_AsDouble(result.ptr());
  if (value == -1 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw std::invalid_argument("restitution: not a number (found " + py::repr(result).cast<std::string>() +
                                "): return one from 0 to 1");
  }
  return value;
}

/// MPFR has one number of digits in a process: that of runs in a call. Made and destroyed with the interpreter's lock.
class Digits {
 public:
  explicit Digits(const Scene& scene) : counted_(scene.run.precision == Precision::mpfr) {
    if (!counted_) return;
    if (users > 0 && digits != scene.run.digits)
      throw Error(scene.place("run.digits"), "another simulation with other digits is in a call",
                  std::to_string(digits), "let that call end first");
    digits = scene.run.digits;
    set_digits(scene);
    ++users;
  }
  ~Digits() {
    if (counted_) --users;
  }
  Digits& operator=(Digits&&) = delete;

 private:
  static inline std::uint64_t digits = 0;
  static inline int users = 0;
  bool counted_;
};

/// Memory that looks for Ctrl-C some times a second during a run; the exception leaves `advance`.
class PolledMemory final : public MemorySink {
 public:
  PolledMemory() : MemorySink(Tables::for_file) {}
  void check_clock() override {
    const auto now = std::chrono::steady_clock::now();
    if (now - polled_ < std::chrono::milliseconds(50)) return;
    polled_ = now;
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  std::chrono::steady_clock::time_point polled_ = std::chrono::steady_clock::now();
};

class HeldRun {
 public:
  /// `threads` = 0: all processors. `of_function`: with a restitution that is a function, which is given to each call.
  HeldRun(const std::string& source, bool is_text, const std::string& name, const std::vector<std::string>& set,
          unsigned threads, bool of_function)
      : scene_(is_text ? parse_scene(source, name + ".toml", set) : read_scene(source, set)),
        threads_(thread_count(threads)), own_law_(of_function) {
    const Digits digits(scene_);
    begin();
  }
  /// Continues from what `save` has written.
  HeldRun(const std::string& checkpoint, unsigned threads) : threads_(thread_count(threads)) {
    StateReader from(checkpoint);
    const JournalHeader& header = from.header().run;
    if (header.kind != kind)
      throw Error({checkpoint}, "a checkpoint of another command", header.kind, "continue it with `cradle resume`",
                  Exit::io);
    scene_ = scene_of(header, checkpoint);
    const Digits digits(scene_);
    begin();
    std::vector<Group> rows;
    try {
      cradle::load(from, rows);
    } catch (const std::invalid_argument& error) {
      throw Error({checkpoint}, "a checkpoint that cannot be continued", error.what(),
                  "use the program that wrote it, or begin anew", Exit::io);
    }
    for (Group& table : rows) sink_.add(std::move(table));
    run_->load(from);
  }

  void advance(const std::string& until, py::handle observer, py::handle law) {
    compute(observer, law, [&] { run_->advance(Decimal(until)); });
  }
  std::uint64_t step(std::uint64_t n, const std::string& until, py::handle observer, py::handle law) {
    compute(observer, law, [&] { n = run_->step(n, Decimal(until)); });
    return n;
  }
  /// f(run), by one caller at a time.
  template <class F> auto use(const F& f) {
    const Use use(*this);
    return f(*run_);
  }

  /// Writes a file from which a run can continue. It replaces only another one. Throws Error, also if the run is over.
  void save(const std::string& path, bool force) {
    const Use use(*this);
    require_own_law("saved");
    const FileClaim claim(path);
    check_overwrite(path, force ? Force::yes : Force::no);
    StateWriter to(
        path, {{kind, 0, effective_toml(scene_), scene_.name}, 0, 0, 0, run_->time().value, run_->counts().collisions});
    run_->put_rows();
    cradle::save(to, sink_.tables());
    run_->save(to);
    to.finish();
  }
  /// Writes the result of a run that is over. It replaces only what `cradle run` would replace. Throws Error. With the
  /// interpreter's lock: HDF5 may be the one of h5py.
  void write(const std::string& path, bool force) {
    const Use use(*this);
    require_own_law("written");
    if (run_->over() == nullptr)
      throw Error({scene_.name}, "not at its end", "t = " + run_->time().text(),
                  "advance to run.until = " + scene_.run.until.text +
                      " first, stop the run here, or save a checkpoint");
    const FileClaim claim(path);
    check_overwrite(path, "run", &scene_, force ? Force::yes : Force::no);
    write_or_keep(result(), path);
  }

 private:
  static constexpr const char* kind = "simulation";  // of its checkpoints (JournalHeader::kind)

  struct Use {
    explicit Use(HeldRun& held_) : held(held_.require_free()), digits(held.scene_) { held.in_use_ = true; }
    ~Use() { held.in_use_ = false, held.executor_.reset(); }
    Use& operator=(Use&&) = delete;
    HeldRun& held;
    Digits digits;
  };
  HeldRun& require_free() {
    if (in_use_)
      throw Error({scene_.name}, "the simulation is in a call", "",
                  "read it between calls of advance and step, or in a function given to every()");
    return *this;
  }

  void begin() {
    RunOptions options{.progress = Progress::Show::never, .held = true};
    if (threads_ > 1)
      options.workers = {threads_,
                         [this](std::size_t jobs, const Workers::Work& work) { for_each(*executor_, jobs, work); }};
    if (own_law_) options.restitution = [this](double speed) { return restitution(law_, speed); };
    run_ = begin_run(scene_, options, sink_);
  }

  template <class F> void compute(py::handle observer, py::handle law, const F& f) {
    const Use use(*this);
    if (const bool wanted = !observer.is_none(); wanted != std::exchange(observed_, wanted))
      run_->observe(wanted ? [this](const ObservedCollision& c) { tools::observe(observer_, c); }
                           : CollisionObserver());
    observer_ = observer, law_ = law;
    if (threads_ > 1) executor_.emplace(threads_);
    if (observed_ || !law.is_none()) return f();
    const py::gil_scoped_release released;
    f();
  }

  void require_own_law(const char* what) const {
    if (own_law_)
      throw Error(scene_.place("restitution"), std::string("a function cannot be ") + what, "",
                  "collect its numbers in Python (every, on_collision)");
  }
  Result result() const {
    if (run_->over()->end == RunEnd::interrupted || !without_collisions(scene_)) return sink_.result();
    MemorySink direct(Tables::for_file);
    run_scene(scene_, {Progress::Show::never}, direct);
    return std::move(direct).result();
  }

  Scene scene_;
  PolledMemory sink_;
  unsigned threads_;
  std::optional<Threads> executor_;  // only during a call: an idle run does not limit what other code uses of threads
  bool own_law_ = false;
  std::unique_ptr<SceneRun> run_;
  py::handle observer_, law_;  // of the present call
  bool observed_ = false, in_use_ = false;
};

}  // namespace cradle::tools
