#include <pybind11/stl/filesystem.h>

#include "fit/correlation/correlation.h"
#include "python/bindings.h"

namespace py = pybind11;
using namespace granrad;

void bind_correlations(py::module_& module) {
  py::class_<Correlation>(module, "Correlation", "View factors of a correlation table at one solid fraction.")
      .def(
          py::init([](const std::filesystem::path& table, double solid_fraction) {
            return Correlation(read_correlation(table), solid_fraction);
          }),
          py::arg("table"), py::arg("solid_fraction"),
          "table: TOML file; solid_fraction: volume of particles per volume. Raises InputError outside its rows.")
      .def("pp", py::vectorize([](Correlation& c, double d_star) { return c.pp(d_star); }), py::arg("d_star"),
           "F between two particles, centres d_star diameters apart (contact at 1). Array in, array out.")
      .def(
          "pw", py::vectorize([](Correlation& c, double h_over_d, double unobstructed) {
            return c.pw(h_over_d, unobstructed);
          }),
          py::arg("h_over_d"), py::arg("unobstructed"),
          "F from a particle to a wall, centre h_over_d diameters from its plane (contact at 0.5);\n"
          "unobstructed: the factor without particles between (cubic tables ignore it). Array in, array out.")
      .def_property_readonly("cutoff", &Correlation::pp_cutoff, "d_star beyond which pp is 0.")
      .def_property_readonly("solid_fraction", &Correlation::solid_fraction);
}
