// The Python module cradle._live: a run that Python holds (held_run.hpp), for cradle/simulation.py.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/python/module/held_run.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

template <class Number> py::array_t<Number> read_only(const std::vector<Number>& numbers) {
  py::array_t<Number> array(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

// A property that reads the run.
template <class F> auto reads(const F& f) {
  return [f](HeldRun& held) { return held.use(f); };
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
      .def("stop", [](HeldRun& held) { held.use([](SceneRun& run) { run.stop(); }); })
      .def("save", &HeldRun::save)
      .def("write", &HeldRun::write)
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
