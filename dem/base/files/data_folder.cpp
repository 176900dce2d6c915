#include "dem/base/files/data_folder.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace granrad {

namespace fs = std::filesystem;

fs::path data_folder() {
  std::vector<fs::path> places;
  if (const char* chosen = std::getenv("GRANRAD_DATA")) places.emplace_back(chosen);
  std::error_code none;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", none); !none)
    places.push_back(program.parent_path().parent_path() / "share" / "granrad");
  places.emplace_back(GRANRAD_INSTALLED_DATA_DIR);
  places.emplace_back(GRANRAD_SOURCE_DATA_DIR);
  for (const auto& place : places)
    if (fs::is_directory(place / "materials", none)) return place;
  return {};
}

fs::path installed_file(const fs::path& name) {
  const fs::path data = data_folder();
  const bool leaves =
      std::any_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
  if (data.empty() || name.empty() || name.is_absolute() || leaves) return {};
  if (fs::is_regular_file(data / name)) return data / name;
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(data))
    if (entry.is_directory()) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  for (const auto& folder : folders)
    if (fs::is_regular_file(folder / name)) return folder / name;
  return {};
}

}  // namespace granrad
