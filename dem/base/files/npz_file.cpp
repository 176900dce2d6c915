#include "dem/base/files/npz_file.h"

#include <fmt/core.h>
#include <unistd.h>
#include <zip.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"

namespace granrad {

namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they stand in memory");

/// The header of an .npy file of version 1.0, filled with blanks so that the data start at a multiple of 64.
std::string npy_header(const std::string& type, const std::string& shape) {
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
  constexpr std::size_t before = 10, alignment = 64;
  dictionary.append(alignment - 1 - (before + dictionary.size()) % alignment, ' ');
  dictionary += '\n';
  const auto length = static_cast<std::uint16_t>(dictionary.size());
  std::string header("\x93NUMPY\x01\x00", 8);
  header.append(reinterpret_cast<const char*>(&length), sizeof length);
  return header + dictionary;
}

template <class T>
std::string bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// The bytes of one array as libzip asks for them: header, then data.
struct Parts {
  std::string_view header, data;
  std::size_t at = 0;

  zip_int64_t give(void* to, zip_uint64_t room) {
    std::size_t given = 0;
    for (const auto& [part, start] : {std::pair{header, std::size_t{0}}, {data, header.size()}}) {
      if (at < start || at >= start + part.size()) continue;
      const std::size_t count = std::min<std::size_t>(room - given, part.size() - (at - start));
      std::memcpy(static_cast<char*>(to) + given, part.data() + (at - start), count);
      given += count;
      at += count;
    }
    return static_cast<zip_int64_t>(given);
  }
};

zip_int64_t answer(void* user, void* data, zip_uint64_t length, zip_source_cmd_t command) {
  auto& parts = *static_cast<Parts*>(user);
  switch (command) {
    case ZIP_SOURCE_OPEN:
      parts.at = 0;
      return 0;
    case ZIP_SOURCE_READ:
      return parts.give(data, length);
    case ZIP_SOURCE_STAT: {
      auto* stat = static_cast<zip_stat_t*>(data);
      zip_stat_init(stat);
      stat->size = parts.header.size() + parts.data.size();
      stat->valid = ZIP_STAT_SIZE;
      return sizeof *stat;
    }
    case ZIP_SOURCE_SUPPORTS:
      return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE,
                                            ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE, -1);
    default:
      return 0;
  }
}

bool add_file(zip_t* archive, const std::string& name, Parts& parts) {
  zip_source_t* source = zip_source_function(archive, answer, &parts);
  if (!source) return false;
  const auto index = zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    return false;
  }
  constexpr zip_uint16_t first_of_1980 = (1 << 5) | 1;
  const auto place = static_cast<zip_uint64_t>(index);
  return zip_set_file_compression(archive, place, ZIP_CM_STORE, 0) == 0 &&
         zip_file_set_dostime(archive, place, 0, first_of_1980, 0) == 0;
}

}  // namespace

void NpzWriter::refer(const std::string& name, const std::string& type, const std::string& shape,
                      const void* data, std::size_t bytes) {
  arrays_.push_back({name, npy_header(type, shape), data, bytes, {}});
}

void NpzWriter::keep(const std::string& name, const std::string& type, const std::string& shape,
                     std::string bytes) {
  arrays_.push_back({name, npy_header(type, shape), nullptr, 0, std::move(bytes)});
}

void NpzWriter::add(const std::string& name, const std::vector<double>& values) {
  refer(name, "<f8", fmt::format("({},)", values.size()), values.data(), values.size() * sizeof(double));
}

void NpzWriter::add(const std::string& name, const std::vector<std::int64_t>& values) {
  refer(name, "<i8", fmt::format("({},)", values.size()), values.data(),
        values.size() * sizeof(std::int64_t));
}

void NpzWriter::add(const std::string& name, const std::vector<std::int32_t>& values) {
  refer(name, "<i4", fmt::format("({},)", values.size()), values.data(),
        values.size() * sizeof(std::int32_t));
}

void NpzWriter::add(const std::string& name, const std::vector<Vec3>& values) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  refer(name, "<f8", fmt::format("({}, 3)", values.size()), values.data(), values.size() * sizeof(Vec3));
}

void NpzWriter::add(const std::string& name, const std::vector<std::string>& texts) {
  std::size_t longest = 1;
  for (const auto& text : texts) longest = std::max(longest, text.size());
  std::string bytes;
  for (auto text : texts) {
    text.resize(longest, '\0');
    bytes += text;
  }
  keep(name, fmt::format("|S{}", longest), fmt::format("({},)", texts.size()), std::move(bytes));
}

void NpzWriter::add_scalar(const std::string& name, double value) {
  keep(name, "<f8", "()", bytes_of(value));
}

void NpzWriter::add_scalar(const std::string& name, std::int64_t value) {
  keep(name, "<i8", "()", bytes_of(value));
}

void NpzWriter::add_scalar(const std::string& name, const std::string& text) {
  keep(name, fmt::format("|S{}", std::max<std::size_t>(1, text.size())), "()",
       text.empty() ? std::string(1, '\0') : text);
}

void NpzWriter::write(const std::filesystem::path& file) const {
  std::error_code ignored;  // what fails here fails below
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  const auto temporary = file.string() + fmt::format(".tmp{}", getpid());
  const auto fail = [&](const std::string& why) {
    std::filesystem::remove(temporary, ignored);
    throw IoError(fmt::format("{}: cannot write ({})", file.string(), why));
  };
  int code = 0;
  zip_t* archive = zip_open(temporary.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (!archive) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    fail(why);
  }
  std::vector<Parts> parts;
  for (const auto& array : arrays_)
    parts.push_back({array.header, array.own.empty()
                                       ? std::string_view(static_cast<const char*>(array.data), array.bytes)
                                       : std::string_view(array.own)});
  bool good = true;
  for (std::size_t k = 0; k < arrays_.size() && good; ++k)
    good = add_file(archive, arrays_[k].name + ".npy", parts[k]);
  if (!good || zip_close(archive) != 0) {
    const std::string why = zip_strerror(archive);
    zip_discard(archive);
    fail(why);
  }
  put_in_place(temporary, file);
}

}  // namespace granrad
