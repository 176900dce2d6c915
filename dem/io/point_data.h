#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "dem/io/snapshot.h"

namespace granrad {

/// Points of a VTK file with their arrays, and the field data of the file.
struct PointData {
  struct Array {
    std::string name;
    std::size_t components = 1;
    std::vector<double> values;  ///< point after point
  };
  std::vector<Vec3> points;
  std::vector<Array> arrays;  ///< of the points
  std::map<std::string, std::vector<double>> fields;
};

/// The particles: arrays by name (ColumnNames; a component k of v is v:k), the time from TimeValue, Time or
/// TIME, step, box and periodic directions where the file has Step, Box and Periodic as our exports do.
/// Throws InputError.
Snapshot particles_of(const std::string& file, const PointData& data, double radius_m);

}  // namespace granrad
