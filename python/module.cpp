#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/base/files/data_folder.h"
#include "dem/base/program.h"
#include "python/bindings.h"

namespace py = pybind11;
using namespace granrad;

std::vector<Vec3> vectors_of(const NumberArray& array, const char* what) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InputError(fmt::format("{}: must be an array [n, 3]", what));
  std::vector<Vec3> out(static_cast<std::size_t>(array.shape(0)));
  const auto at = array.unchecked<2>();
  for (py::ssize_t i = 0; i < at.shape(0); ++i)
    out[static_cast<std::size_t>(i)] = {at(i, 0), at(i, 1), at(i, 2)};
  return out;
}

std::vector<double> numbers_of(const NumberArray& array, std::size_t count, const char* what) {
  const auto size = static_cast<std::size_t>(array.size());
  if (size != 1 && size != count)
    throw InputError(fmt::format("{}: has {} values; must be one, or one for each of the {} particles", what,
                                 size, count));
  std::vector<double> out(array.data(), array.data() + size);
  if (size == 1) out.resize(count, out[0]);
  return out;
}

void bind_errors(py::module_& module) {
  static py::exception<Error> base(module, "GranradError", PyExc_RuntimeError);
  static py::exception<InputError> input(module, "InputError",
                                         py::make_tuple(base, py::handle(PyExc_ValueError)));
  static py::exception<NumericalError> numerical(module, "NumericalError",
                                                 py::make_tuple(base, py::handle(PyExc_ArithmeticError)));
  static py::exception<IoError> io(module, "IoError", py::make_tuple(base, py::handle(PyExc_OSError)));
  static py::exception<ThresholdMissed> missed(module, "ThresholdMissed", base);
  base.attr("__doc__") = "What the library reports; its text says what is wrong and what to try.";
  input.attr("__doc__") = "What was given is wrong: every problem, one a line. A ValueError.";
  numerical.attr("__doc__") = "A computation has no right result. An ArithmeticError.";
  io.attr("__doc__") = "A file cannot be read or written. An OSError.";
  missed.attr("__doc__") = "A threshold that was asked for is missed.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      input(error.what());
    } catch (const NumericalError& error) {
      numerical(error.what());
    } catch (const IoError& error) {
      io(error.what());
    } catch (const ThresholdMissed& error) {
      missed(error.what());
    } catch (const Error& error) {
      base(error.what());
    }
  });
}

PYBIND11_MODULE(_granrad, module) {
  module.doc() = "Compiled part of granrad; see the package granrad.";
  module.attr("__version__") = program_version();
  module.attr("git_sha") = program_git_sha();
  module.def(
      "data_folder", [] { return data_folder().string(); },
      "Folder of materials, correlations and example scenes.");
  bind_errors(module);
  bind_exchange(module);
  bind_scenes(module);
  bind_correlations(module);
}
