#include "dem/liggghts/stl_file.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "dem/base/error.h"

namespace granrad::liggghts {

StlFile::StlFile(const std::vector<std::array<Vec3, 3>>& triangles)
    : path_((std::filesystem::temp_directory_path() / "granrad_mesh_XXXXXX.stl").string()) {
  const int handle = mkstemps(path_.data(), 4);
  if (handle < 0) throw IoError(path_ + " (cannot be made); set TMPDIR to a folder that can be written");
  close(handle);
  std::ofstream out(path_);
  out << "solid wall\n";
  for (const auto& t : triangles) {
    const Vec3 n = normalized(cross(t[1] - t[0], t[2] - t[0]));
    out << fmt::format("facet normal {:.17g} {:.17g} {:.17g}\nouter loop\n", n.x, n.y, n.z);
    for (const auto& p : t) out << fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
    out << "endloop\nendfacet\n";
  }
  out << "endsolid wall\n";
  out.close();
  if (!out) throw IoError(path_ + " (cannot be written); set TMPDIR to a folder with space");
}

StlFile::~StlFile() {
  std::remove(path_.c_str());
}

}  // namespace granrad::liggghts
