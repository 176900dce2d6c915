#include "coupling/simulation/simulation.h"
#include "python/bindings.h"

namespace py = pybind11;
using namespace granrad;

namespace {

/// A case and its simulation, which refers to it.
class PythonSimulation {
 public:
  PythonSimulation(const std::string& scene, const std::vector<std::string>& overrides, int threads)
      : case_(std::make_unique<Case>(read_case(scene, overrides))),
        simulation_(std::make_unique<Simulation>(*case_, threads)) {
    simulation_->start();
  }

  /// Until `until_s` or the end; the rows of the history, one an output interval.
  py::list run(double until_s) {
    py::list rows;
    while (!simulation_->finished() && bed().time_s < until_s) {
      bool due = false;
      {
        py::gil_scoped_release release;
        simulation_->advance();
        due = simulation_->plan().row_at(simulation_->tick());
      }
      if (due) rows.append(row());
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    return rows;
  }

  py::dict row() {
    const HistoryRow row = simulation_->record().row;
    py::dict out;
    const auto columns = history_columns();
    for (std::size_t k = 0; k < columns.size(); ++k) out[columns[k].name] = row.values()[k];
    return out;
  }

  py::dict heats(std::uint64_t draw) {
    HeatModel::ParticleHeat heat;
    {
      py::gil_scoped_release release;
      heat = simulation_->draw_radiation(draw);
    }
    py::dict out;
    out["heat_W"] = array_of(heat.heat_W);
    out["standard_error_W"] = array_of(heat.standard_error_W);
    return out;
  }

  const Bed& bed() const { return simulation_->bed(); }
  bool finished() const { return simulation_->finished(); }
  std::string scene() const { return case_->effective_text; }

 private:
  std::unique_ptr<Case> case_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace

void bind_scenes(py::module_& module) {
  py::class_<PythonSimulation>(module, "CompiledSimulation")
      .def(py::init<const std::string&, const std::vector<std::string>&, int>(), py::arg("scene"),
           py::arg("overrides"), py::arg("threads"))
      .def("run", &PythonSimulation::run, py::arg("until_s"))
      .def("row", &PythonSimulation::row)
      .def("heats", &PythonSimulation::heats, py::arg("draw"))
      .def_property_readonly("finished", &PythonSimulation::finished)
      .def_property_readonly("scene", &PythonSimulation::scene)
      .def_property_readonly("time_s", [](const PythonSimulation& s) { return s.bed().time_s; })
      .def_property_readonly("ids", [](const PythonSimulation& s) { return array_of(s.bed().id); })
      .def_property_readonly("positions_m",
                             [](const PythonSimulation& s) { return array_of_vectors(s.bed().position_m); })
      .def_property_readonly("velocities_m_s",
                             [](const PythonSimulation& s) { return array_of_vectors(s.bed().velocity_m_s); })
      .def_property_readonly("radii_m", [](const PythonSimulation& s) { return array_of(s.bed().radius_m); })
      .def_property_readonly("temperatures_K",
                             [](const PythonSimulation& s) { return array_of(s.bed().temperature_K); });
}
