#pragma once
#include <array>
#include <string>
#include <vector>

#include "dem/base/vec3.h"

namespace granrad::liggghts {

/// Triangles as a text STL file of full precision for as long as this object lives. Throws IoError.
class StlFile {
 public:
  explicit StlFile(const std::vector<std::array<Vec3, 3>>& triangles);
  ~StlFile();
  StlFile(const StlFile&) = delete;
  StlFile& operator=(const StlFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace granrad::liggghts
