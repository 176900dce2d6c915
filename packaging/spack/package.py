from spack.package import *


class Granrad(CMakePackage):
    """Radiation and conduction in granular flows: view factors, correlations, coupled discrete elements."""

    license("MIT")
    version("main", branch="main")
    variant("python", default=False, description="the Python package")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    for library in ("embree@3.13:4", "eigen@3.4:", "ceres-solver", "hdf5+hl", "cli11", "fmt@9:", "nlohmann-json", "boost", "libpng", "pugixml",
                    "udunits", "tomlplusplus", "random123", "zlib-api", "libzip", "muparser"):
        depends_on(library)
    depends_on("py-pybind11", when="+python")
    extends("python", when="+python")
    depends_on("py-numpy", when="+python", type="run")
    depends_on("py-scipy", when="+python", type="run")
    depends_on("py-h5py", when="+python", type="run")

    def cmake_args(self):
        return [self.define("GRANRAD_TESTS", False), self.define("GRANRAD_LIGGGHTS_ENGINE", False), self.define("GRANRAD_MPI", False),
                self.define_from_variant("GRANRAD_PYTHON", "python")]
