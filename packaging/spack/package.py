from spack.package import *


class Granrad(CMakePackage):
    """Radiation and conduction in granular flows: view factors, correlations, coupled discrete elements.

    Built from the source tree at hand: `spack dev-build granrad@main` there.
    """

    license("MIT")
    version("main")
    variant("python", default=False, description="the Python package")
    variant("mpi", default=False, description="the plug-in for several processes on one case")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("git", type="build")
    for library in ("embree@3.13:4", "eigen@3.4:", "ceres-solver", "hdf5", "cli11", "fmt@9:", "nlohmann-json", "boost", "libpng",
                    "pugixml", "udunits", "tomlplusplus", "random123", "zlib-api", "libzip", "muparser"):
        depends_on(library)
    depends_on("mpi", when="+mpi")
    extends("python", when="+python")
    depends_on("py-pybind11", when="+python")
    for package in ("py-numpy", "py-scipy", "py-h5py"):
        depends_on(package, when="+python", type="run")

    def cmake_args(self):
        return [self.define("GRANRAD_TESTS", False), self.define("GRANRAD_LIGGGHTS_ENGINE", False),
                self.define_from_variant("GRANRAD_MPI", "mpi"), self.define_from_variant("GRANRAD_PYTHON", "python"),
                self.define("GRANRAD_PYTHON_DIR", python_platlib if self.spec.satisfies("+python") else "lib/python3")]
