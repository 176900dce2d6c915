#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace granrad {

/// Writes `text` to a temporary name beside `file`, fsyncs and renames: the file is whole or not there.
/// Creates the folder. Throws IoError (folder not writable, disk full).
void write_text_file(const std::filesystem::path& file, const std::string& text);

/// All of a file. Throws IoError.
std::string read_text_file(const std::filesystem::path& file);

/// Fsyncs a whole file of a temporary name and gives it its own. Throws IoError; the temporary file is gone then.
void put_in_place(const std::filesystem::path& temporary, const std::filesystem::path& file);

/// FNV-1a, 64 bits: the same on every machine.
std::uint64_t text_hash(const std::string& text);

}  // namespace granrad
