#include <nlohmann/json.hpp>

#include "dem/base/text_file.h"
#include "dem/io/snapshot.h"

namespace granrad {

void write_series(const std::filesystem::path& series_file,
                  const std::vector<std::pair<std::filesystem::path, double>>& frames) {
  nlohmann::ordered_json series{{"file-series-version", "1.0"}, {"files", nlohmann::ordered_json::array()}};
  const auto folder = std::filesystem::absolute(series_file).parent_path();
  for (const auto& [file, time_s] : frames)
    series["files"].push_back(
        {{"name", std::filesystem::absolute(file).lexically_relative(folder).generic_string()},
         {"time", time_s}});
  write_text_file(series_file, series.dump(1) + "\n");
}

}  // namespace granrad
