#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace granrad {

/// Everything in a file, unpacked when it is compressed by gzip. Throws IoError (no such file, a folder, a
/// damaged or cut gzip file).
std::string file_bytes(const std::filesystem::path& file);

/// A zlib stream of known unpacked size; nothing when it is damaged, or has another size.
std::optional<std::string> inflated(std::string_view packed, std::size_t size);

}  // namespace granrad
