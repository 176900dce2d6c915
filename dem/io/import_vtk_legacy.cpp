#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

#include "dem/base/error.h"
#include "dem/io/import_vtk.h"
#include "dem/io/point_data.h"

namespace granrad {

namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

std::string upper(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// Names are written with %20 for a blank.
std::string decoded(std::string_view name) {
  std::string text;
  for (std::size_t k = 0; k < name.size(); ++k) {
    unsigned char code = 0;
    if (name[k] == '%' && k + 2 < name.size() &&
        std::from_chars(name.data() + k + 1, name.data() + k + 3, code, 16).ptr == name.data() + k + 3) {
      text += static_cast<char>(code);
      k += 2;
    } else {
      text += name[k];
    }
  }
  return text;
}

/// Bytes of a big-endian number.
template <class T>
double big_endian(const char* bytes) {
  char turned[sizeof(T)];
  std::memcpy(turned, bytes, sizeof(T));
  if constexpr (std::endian::native == std::endian::little) std::reverse(turned, turned + sizeof(T));
  T value;
  std::memcpy(&value, turned, sizeof(T));
  return static_cast<double>(value);
}

struct Type {
  std::size_t bytes;
  double (*value)(const char*);
};

class LegacyReader {
 public:
  LegacyReader(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  PointData read() {
    line();  // # vtk DataFile Version
    line();  // title
    const std::string kind = upper(word());
    if (kind != "ASCII" && kind != "BINARY") fail("the third line must be ASCII or BINARY");
    binary_ = kind == "BINARY";
    while (!at_end()) take(upper(word()));
    if (!has_points_) fail("there are no POINTS");
    return std::move(data_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    throw InputError(fmt::format("{}:{}: {}", file_, 1 + std::count(text_.begin(), end, '\n'), what));
  }
  bool at_end() {
    at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
    return at_ == text_.size();
  }
  std::string_view word() {
    if (at_end()) fail("the file is cut short");
    const auto end = std::min(text_.find_first_of(blanks, at_), text_.size());
    const auto found = text_.substr(at_, end - at_);
    at_ = end;
    return found;
  }
  /// The rest of the line.
  std::string_view line() {
    const auto end = std::min(text_.find('\n', at_), text_.size());
    const auto found = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    return found;
  }
  std::size_t count(const char* of) {
    const auto text = word();
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value > text_.size())
      fail(fmt::format("{} = {} (must be a number that the file has room for)", of, text));
    return value;
  }

  Type type() {
    const std::string name = upper(word());
    if (name == "DOUBLE") return {8, big_endian<double>};
    if (name == "FLOAT") return {4, big_endian<float>};
    if (name == "INT" || name == "VTKIDTYPE") return {4, big_endian<std::int32_t>};
    if (name == "LONG" || name == "VTKTYPEINT64") return {8, big_endian<std::int64_t>};
    if (name == "UNSIGNED_LONG" || name == "VTKTYPEUINT64") return {8, big_endian<std::uint64_t>};
    if (name == "UNSIGNED_INT") return {4, big_endian<std::uint32_t>};
    if (name == "SHORT") return {2, big_endian<std::int16_t>};
    if (name == "UNSIGNED_SHORT") return {2, big_endian<std::uint16_t>};
    if (name == "CHAR" || name == "SIGNED_CHAR") return {1, big_endian<signed char>};
    if (name == "UNSIGNED_CHAR") return {1, big_endian<unsigned char>};
    fail(fmt::format("type {} is not read", name));
  }

  std::vector<double> values(std::size_t rows, std::size_t columns, const Type& type) {
    if (binary_) line();  // numbers start after the end of the header's line
    const std::size_t room = (text_.size() - at_) / (binary_ ? type.bytes : 1);
    if (columns > 0 && rows > room / columns) fail("the file is cut short");
    std::vector<double> all;
    all.reserve(rows * columns);
    for (std::size_t k = 0; k < rows * columns; ++k)
      if (binary_) {
        all.push_back(type.value(text_.data() + at_));
        at_ += type.bytes;
      } else {
        all.push_back(number());
      }
    return all;
  }
  double number() {
    auto text = word();
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::quiet_NaN();
    if (error != std::errc() || end != text.data() + text.size())
      fail(fmt::format("{} is not a number", text));
    return value;
  }

  void take(const std::string& keyword) {
    if (keyword == "DATASET") {
      if (const std::string kind = upper(word()); kind != "POLYDATA" && kind != "UNSTRUCTURED_GRID")
        fail(advised(fmt::format("DATASET {} (no particles)", kind), "write POLYDATA or UNSTRUCTURED_GRID"));
    } else if (keyword == "POINTS") {
      take_points();
    } else if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
      of_points_ = keyword == "POINT_DATA";
      tuples_ = count("the number of values");
      in_data_ = true;
    } else if (keyword == "METADATA") {
      line();
      while (at_ < text_.size() && line().find_first_not_of(blanks) != std::string_view::npos) continue;
    } else if (!take_cells(keyword) && !take_attribute(keyword)) {
      fail(fmt::format("{} is not a keyword of a VTK file", keyword.substr(0, 40)));
    }
  }

  void take_points() {
    const std::size_t n = count("the number of points");
    const auto flat = values(n, 3, type());
    for (std::size_t i = 0; i < n; ++i)
      data_.points.push_back({flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]});
    has_points_ = true;
  }

  bool take_cells(const std::string& keyword) {
    static const Type whole{4, big_endian<std::int32_t>};
    if (keyword == "CELL_TYPES") {
      const std::size_t n = count("the number of cells");
      values(n, 1, whole);
      return true;
    }
    if (keyword == "OFFSETS" || keyword == "CONNECTIVITY") {
      values(keyword == "OFFSETS" ? offsets_ : connections_, 1, type());
      return true;
    }
    for (const char* name : {"VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS"}) {
      if (keyword != name) continue;
      offsets_ = count("the number of cells"), connections_ = count("the size of the cells");
      const auto before = at_;
      if (!at_end() && text_.substr(at_).starts_with("OFFSETS")) return true;
      at_ = before;
      values(connections_, 1, whole);
      return true;
    }
    return false;
  }

  bool take_attribute(const std::string& keyword) {
    if (keyword == "FIELD") return take_field();
    if (keyword == "LOOKUP_TABLE") {
      word();
      const std::size_t rows = count("the size of the table");
      values(rows, 4, {1, big_endian<unsigned char>});
      return true;
    }
    const std::string kinds =
        " SCALARS VECTORS NORMALS TENSORS TENSORS6 GLOBAL_IDS PEDIGREE_IDS COLOR_SCALARS "
        "TEXTURE_COORDINATES ";
    if (kinds.find(" " + keyword + " ") == kinds.npos) return false;
    const std::string name = decoded(word());
    std::size_t columns = keyword == "VECTORS" || keyword == "NORMALS" ? 3
                          : keyword == "TENSORS"                       ? 9
                          : keyword == "TENSORS6"                      ? 6
                                                                       : 1;
    if (keyword == "COLOR_SCALARS" || keyword == "TEXTURE_COORDINATES")
      columns = count("the number of values");
    const Type kind = keyword == "COLOR_SCALARS" ? Type{1, big_endian<unsigned char>} : type();
    if (keyword == "SCALARS") columns = scalar_columns();
    keep(name, columns, values(tuples_, columns, kind));
    return true;
  }

  /// SCALARS name type [columns], then the line LOOKUP_TABLE name.
  std::size_t scalar_columns() {
    const std::string_view rest = line();
    std::size_t columns = 1;
    if (const auto first = rest.find_first_not_of(blanks); first != rest.npos)
      std::from_chars(rest.data() + first, rest.data() + rest.size(), columns);
    if (columns < 1 || columns > 4) fail("SCALARS have 1 to 4 values a point");
    const auto before = at_;
    if (!at_end() && upper(word()) == "LOOKUP_TABLE") {
      word();
      return columns;
    }
    at_ = before > 0 ? before - 1 : 0;  // values() of binary data passes over one line end
    return columns;
  }

  bool take_field() {
    word();  // name
    const std::size_t arrays = count("the number of arrays");
    for (std::size_t k = 0; k < arrays; ++k) {
      std::string_view name = word();
      if (upper(name) == "METADATA") {
        take("METADATA");
        name = word();
      }
      const std::size_t columns = count("the number of components"), rows = count("the number of tuples");
      const Type kind = type();
      auto read = values(rows, columns, kind);
      if (in_data_)
        keep(decoded(name), columns, std::move(read));
      else
        data_.fields[decoded(name)] = std::move(read);
    }
    return true;
  }

  void keep(const std::string& name, std::size_t columns, std::vector<double> read) {
    if (of_points_ && columns > 0) data_.arrays.push_back({name, columns, std::move(read)});
  }

  const std::string& file_;
  std::string_view text_;
  std::size_t at_ = 0, tuples_ = 0, offsets_ = 0, connections_ = 0;
  bool binary_ = false, of_points_ = false, in_data_ = false, has_points_ = false;
  PointData data_;
};

}  // namespace

Snapshot import_vtk_legacy(const std::string& file, std::string_view text, double radius_m) {
  return particles_of(file, LegacyReader(file, text).read(), radius_m);
}

}  // namespace granrad
