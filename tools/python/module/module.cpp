// The Python module cradle._live: a run that Python holds (tools/live/live_run.hpp), for cradle/simulation.py.
//
// Functions of the caller come as arguments of `advance` and `step` and are only borrowed, so that Python's garbage
// collector sees all references. A call with such a function keeps the interpreter's lock, which the interpreter hands
// on while the function runs; a call without one gives it back, and takes it some times a second to see whether Ctrl-C
// was pressed. A run that is in a call refuses others: from another thread, or from a function that it has called.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/live/live_run.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/support/version.hpp"

namespace py = pybind11;

namespace cradle::tools {

namespace {

// cradle.Collision, a named tuple. The module has it for as long as the interpreter lives.
PyTypeObject* collision_type = nullptr;

// The result of a call, a new reference. Throws the exception of the function.
py::object called(py::handle function, py::object argument) {
  PyObject* const result = PyObject_CallOneArg(function.ptr(), argument.ptr());
  if (result == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(result);
}

void observe(py::handle function, const ObservedCollision& c) {
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

double restitution(py::handle function, double closing_speed) {
  const py::object result = called(function, py::float_(closing_speed));
  const double value = PyFloat_AsDouble(result.ptr());
  if (value == -1 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw std::invalid_argument("restitution: not a number (found " + py::repr(result).cast<std::string>() +
                                "): return one from 0 to 1");
  }
  return value;
}

void poll() {
  const py::gil_scoped_acquire locked;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// MPFR has one number of digits in a process: that of runs in a call. Made and destroyed with the interpreter's lock.
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
  Digits(const Digits&) = delete;
  Digits& operator=(const Digits&) = delete;

 private:
  static inline std::uint64_t digits = 0;
  static inline int users = 0;
  bool counted_;
};

class HeldRun {
 public:
  HeldRun(const std::string& source, bool is_text, const std::string& name, const std::vector<std::string>& set,
          unsigned threads, bool of_function) {
    begin(threads, of_function, [&](const LiveOptions& options) {
      return std::make_unique<LiveRun>(is_text ? parse_scene(source, name + ".toml", set) : read_scene(source, set),
                                       options);
    });
  }
  HeldRun(const std::string& checkpoint, unsigned threads) {
    begin(threads, false, [&](const LiveOptions& options) { return std::make_unique<LiveRun>(checkpoint, options); });
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

 private:
  struct Use {
    explicit Use(HeldRun& held_) : held(free(held_)), digits(held.run_->scene()) { held.in_use_ = true; }
    ~Use() { held.in_use_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    static HeldRun& free(HeldRun& held) {
      if (held.in_use_)
        throw Error({held.run_->scene().name, 0, ""}, "the simulation is in a call", "",
                    "read it between calls of advance and step, or in a function given to every()");
      return held;
    }
    HeldRun& held;
    Digits digits;
  };

  template <class F> void begin(unsigned threads, bool of_function, const F& make) {
    std::optional<Digits> digits;
    LiveOptions options{threads, poll, {}, [&](const Scene& scene) { digits.emplace(scene); }};
    if (of_function) options.restitution = [this](double speed) { return restitution(law_, speed); };
    run_ = make(options);
  }

  template <class F> void compute(py::handle observer, py::handle law, const F& f) {
    const Use use(*this);
    if (const bool wanted = !observer.is_none(); wanted != std::exchange(observed_, wanted))
      run_->run().observe(wanted ? [this](const ObservedCollision& c) { tools::observe(observer_, c); }
                                 : std::function<void(const ObservedCollision&)>());
    observer_ = observer, law_ = law;
    if (observed_ || !law.is_none()) return f();
    const py::gil_scoped_release released;
    f();
  }

  std::unique_ptr<LiveRun> run_;
  py::handle observer_, law_;  // of the present call
  bool observed_ = false, in_use_ = false;
};

template <class Number> py::array_t<Number> read_only(const std::vector<Number>& numbers) {
  py::array_t<Number> array(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

// A property that reads the run.
template <class F> auto reads(const F& f) {
  return [f](HeldRun& held) { return held.use([&](LiveRun& live) { return f(live.run()); }); };
}

// Raises cradle.Error with the message and the status.
void raise(const std::string& message, Exit status) {
  const py::object type = py::module_::import("cradle.errors").attr("Error");
  // A message may show bytes of a file that are no text.
  const auto text = py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(message.data(), static_cast<Py_ssize_t>(message.size()), "replace"));
  const py::object shown = py::module_::import("cradle.errors").attr("in_python")(text);
  const py::object error = type(shown, static_cast<int>(status));
  PyErr_SetObject(type.ptr(), error.ptr());
}
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    raise(error.what(), error.status);
  } catch (const std::logic_error& error) {  // of the engine: an argument or a value that cannot be
    raise(error.what(), Exit::bad_input);
  }
}

}  // namespace

}  // namespace cradle::tools

PYBIND11_MODULE(_live, module) {
  using namespace cradle::tools;
  module.doc() = "Runs that Python holds. Use cradle.Simulation.";
  module.attr("version") = std::string(version);
  const py::object collision = py::module_::import("cradle.simulation").attr("Collision");
  collision_type = reinterpret_cast<PyTypeObject*>(py::object(collision).release().ptr());
  py::register_local_exception_translator(translate);
  py::class_<HeldRun> run_class(module, "Run");
  run_class
      .def(py::init<const std::string&, bool, const std::string&, const std::vector<std::string>&, unsigned, bool>())
      .def(py::init<const std::string&, unsigned>())
      .def("advance", &HeldRun::advance)
      .def("step", &HeldRun::step)
      .def("stop", [](HeldRun& held) { held.use([](LiveRun& live) { live.run().stop(); }); })
      .def("save", [](HeldRun& held, const std::string& path) { held.use([&](LiveRun& run) { run.save(path); }); })
      // With the lock: HDF5 may be the one of h5py.
      .def("write",
           [](HeldRun& held, const std::string& path, bool force) {
             held.use([&](LiveRun& run) { run.write(path, force ? Force::yes : Force::no); });
           })
      .def_property_readonly("index", reads([](SceneRun& run) { return read_only(run.now().index()); }))
      .def_property_readonly("name", reads([](SceneRun& run) { return run.scene().name; }))
      .def_property_readonly("scene", reads([](SceneRun& run) { return effective_toml(run.scene()); }))
      .def_property_readonly("until", reads([](SceneRun& run) { return run.scene().run.until.text; }))
      .def_property_readonly("precision", reads([](SceneRun& run) { return precision_name(run.scene().run); }))
      .def_property_readonly("collisions", reads([](SceneRun& run) { return run.counts().collisions; }))
      .def_property_readonly("merges", reads([](SceneRun& run) { return run.counts().merges; }))
      .def_property_readonly("time", reads([](SceneRun& run) { return run.time().value; }))
      .def_property_readonly("time_text", reads([](SceneRun& run) { return run.time().text(); }))
      .def_property_readonly("energy", reads([](SceneRun& run) { return run.now().state().energy.value; }))
      .def_property_readonly("energy_text", reads([](SceneRun& run) { return run.now().state().energy.text(); }))
      // None during the run, then how it ended: outcome, exit status of `cradle run`, what that prints, its warning.
      .def_property_readonly("over", reads([](SceneRun& run) -> py::object {
                               const RunOutcome* over = run.over();
                               if (over == nullptr) return py::none();
                               const EndRow& end = end_row(over->end);
                               return py::make_tuple(std::string(end.text), static_cast<int>(end.status), over->report,
                                                     over->warning);
                             }));
  using Column = RunState::Column;
  for (const auto& [name, column] :
       {std::pair("x", Column::x), std::pair("v", Column::v), std::pair("m", Column::m), std::pair("gap", Column::gap),
        std::pair("closing_speed", Column::closing_speed)}) {
    run_class.def_property_readonly(
        name, reads([which = column](SceneRun& run) { return read_only(run.now().column(which)); }));
    run_class.def_property_readonly((std::string(name) + "_text").c_str(),
                                    reads([which = column](SceneRun& run) { return run.now().column_text(which); }));
  }
}
