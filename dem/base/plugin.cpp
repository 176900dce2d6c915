#include "dem/base/plugin.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <vector>

#include "dem/base/error.h"

namespace granrad {

namespace fs = std::filesystem;

fs::path plugin_file(const std::string& name) {
  std::error_code none;
  std::vector<fs::path> homes;  // of the program, and of the library this code is in (of Python, say)
  homes.push_back(fs::read_symlink("/proc/self/exe", none).parent_path());
  Dl_info self{};
  if (dladdr(reinterpret_cast<void*>(&plugin_file), &self) != 0 && self.dli_fname)
    homes.push_back(fs::absolute(self.dli_fname, none).parent_path());
  for (const auto& home : homes)
    for (const auto& folder : {home / "granrad", home.parent_path() / "lib" / "granrad"})
      if (const auto file = folder / (name + ".so"); fs::is_regular_file(file, none)) return file;
  return {};
}

void* plugin_function(const fs::path& file, const char* function) {
  void* part = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* found = part ? dlsym(part, function) : nullptr;
  if (found) return found;
  const char* why = dlerror();
  throw InputError(advised(fmt::format("{} cannot be used ({})", file.string(), why ? why : "unknown reason"),
                           "install what it needs, or build again"));
}

}  // namespace granrad
