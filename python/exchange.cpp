#include <fmt/core.h>

#include "dem/base/error.h"
#include "fit/trace/snapshot_enclosure.h"
#include "fit/trace/trace_snapshot.h"
#include "python/bindings.h"
#include "raytrace/exact.h"

namespace py = pybind11;
using namespace granrad;

namespace {

/// name -> corners [n, 3], counter-clockwise seen from the particles.
std::vector<Wall> walls_of(const py::dict& polygons) {
  std::vector<Wall> walls;
  for (const auto& [name, corners] : polygons) {
    Wall wall;
    wall.name = py::cast<std::string>(name);
    wall.vertices = vectors_of(py::cast<NumberArray>(corners), wall.name.c_str());
    if (wall.vertices.size() < 3)
      throw InputError(fmt::format("wall {}: has fewer than three corners", wall.name));
    walls.push_back(std::move(wall));
  }
  return walls;
}

Bed bed_of(const NumberArray& centres, const NumberArray& radii, const py::object& box,
           const py::object& walls) {
  Bed bed;
  bed.materials.emplace_back();
  const auto points = vectors_of(centres, "centres");
  const auto radius = numbers_of(radii, points.size(), "radii");
  if (points.empty()) throw InputError("centres: there are no particles");
  bed.box = {points[0], points[0]};
  const auto include = [&](const Vec3& p, double r) {
    for (int axis = 0; axis < 3; ++axis) {
      bed.box.min[axis] = std::min(bed.box.min[axis], p[axis] - r);
      bed.box.max[axis] = std::max(bed.box.max[axis], p[axis] + r);
    }
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(radius[i] > 0)) throw InputError(fmt::format("radii[{}] = {} (must be > 0)", i, radius[i]));
    bed.add(points[i], {}, radius[i], 300);
    include(points[i], radius[i]);
  }
  if (!walls.is_none())
    for (auto& wall : walls_of(py::cast<py::dict>(walls))) {
      for (const auto& v : wall.vertices) include(v, 0);
      bed.walls.push_back(std::move(wall));
    }
  if (!box.is_none()) {
    const auto corners = vectors_of(py::cast<NumberArray>(box), "box");
    if (corners.size() != 2) throw InputError("box: must be [[x0, y0, z0], [x1, y1, z1]]");
    bed.box = {corners[0], corners[1]};
    for (auto& wall : box_walls(bed.box)) bed.walls.push_back(wall);
  }
  for (auto& wall : bed.walls) wall.role = WallRole::isothermal;
  return bed;
}

py::dict matrices_of(const ViewFactorFile& traced) {
  const ExchangeAreas& x = traced.closed;
  std::vector<double> value(x.value.size()), error;
  if (!x.variance.empty()) error.resize(x.value.size());
  for (std::size_t i = 0; i < x.area_m2.size(); ++i)
    for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      value[at] = x.area_m2[i] > 0 ? x.value[at] / x.area_m2[i] : 0;
      if (!error.empty()) error[at] = x.area_m2[i] > 0 ? std::sqrt(x.variance[at]) / x.area_m2[i] : 0;
    }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < traced.enclosure.sphere_count(); ++i)
    names.push_back(fmt::format("particle {}", i));
  for (const auto& wall : traced.enclosure.walls) names.push_back(wall.name);
  names.emplace_back("open");
  py::dict out;
  out["row_begin"] = array_of(x.pattern.row_begin);
  out["column"] = array_of(x.pattern.column);
  out["value"] = array_of(value);
  out["standard_error"] = array_of(error);
  out["area_m2"] = array_of(x.area_m2);
  out["particle"] = array_of(traced.enclosure.particle);
  out["names"] = names;
  out["failed"] = traced.check.failed;
  out["rays"] = traced.spent.rays;
  return out;
}

py::dict trace_arrays(const NumberArray& centres, const NumberArray& radii, const py::object& box,
                      const py::object& walls, const std::string& method, double rays,
                      const std::optional<double>& error, const std::optional<double>& emissivity,
                      const std::optional<double>& wall_emissivity, std::uint64_t seed, int threads) {
  if (method != "embree" && method != "lines")
    throw InputError(fmt::format("method = \"{}\" (must be \"embree\" or \"lines\")", method));
  const Bed bed = bed_of(centres, radii, box, walls);
  TraceSettings settings;
  settings.method = method == "lines" ? TraceMethod::lines : TraceMethod::embree;
  settings.rays = rays;
  settings.error = error.value_or(0);
  settings.emissivity = emissivity;
  settings.wall_emissivity = wall_emissivity;
  settings.seed = seed;
  settings.threads = threads;
  ViewFactorFile traced;
  {
    py::gil_scoped_release release;
    traced = trace(make_enclosure(bed, bed.box), settings, "arrays");
  }
  return matrices_of(traced);
}

}  // namespace

void bind_exchange(py::module_& module) {
  module.def("trace_arrays", &trace_arrays, py::arg("centres"), py::arg("radii"), py::arg("box") = py::none(),
             py::arg("walls") = py::none(), py::arg("method") = "embree", py::arg("rays") = 10000.0,
             py::arg("error") = py::none(), py::arg("emissivity") = py::none(),
             py::arg("wall_emissivity") = py::none(), py::arg("seed") = 1, py::arg("threads") = 0);
  module.def(
      "exact_two_sphere", py::vectorize(&exact_two_sphere), py::arg("r1"), py::arg("r2"), py::arg("distance"),
      "View factor from a sphere of radius r1 to one of radius r2, centres `distance` apart, nothing between.");
}
