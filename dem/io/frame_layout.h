#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "dem/bed/columns.h"
#include "dem/bed/material.h"

namespace granrad {

/// What frame_writer and frame_reader agree on.
inline constexpr const char* frame_format = "granrad.frame";
/// 2: texts of fixed length. 1 is read, too.
inline constexpr std::int64_t frame_version = 3;

/// Where viewers look for a column of the Bed; /granrad/particles/NAME is a second name of it.
template <class T>
std::string view_path(const BedColumn<T>& column) {
  return std::string(column.name) == "position_m" ? "/VTKHDF/Points"
                                                  : std::string("/VTKHDF/PointData/") + column.view;
}

}  // namespace granrad
