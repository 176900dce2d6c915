#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include "dem/base/error.h"
#include "dem/base/files/file_bytes.h"
#include "dem/base/files/text_lines.h"
#include "dem/io/import_vtk.h"
#include "dem/io/point_data.h"

namespace granrad {

namespace {

/// Base64, also of several parts one after the other, each with its padding; stops at what is none.
std::string from_base64(std::string_view text) {
  static const auto code = [] {
    std::array<int, 256> table{};
    table.fill(-1);
    const std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t k = 0; k < letters.size(); ++k)
      table[static_cast<unsigned char>(letters[k])] = static_cast<int>(k);
    return table;
  }();
  std::string bytes;
  std::uint32_t bits = 0;
  int letters = 0, padding = 0;
  for (const char c : text) {
    const int value = code[static_cast<unsigned char>(c)];
    if (std::isspace(static_cast<unsigned char>(c))) continue;
    if (value < 0 && c != '=') break;
    padding += c == '=';
    bits = bits << 6 | static_cast<std::uint32_t>(std::max(value, 0));
    if (++letters < 4) continue;
    for (int k = 0; k < 3 - padding; ++k) bytes += static_cast<char>(bits >> (16 - 8 * k) & 255);
    bits = 0, letters = 0, padding = 0;
  }
  return bytes;
}

class XmlReader {
 public:
  XmlReader(const std::string& file, std::string_view text) : file_(file) {
    std::string head(text);
    if (const auto appended = head.find("<AppendedData"); appended != head.npos) {
      const auto begin = head.find('_', appended);
      if (begin == head.npos) fail("AppendedData has no '_'");
      appended_ = text.substr(begin + 1);
      appended_base64_ = head.substr(appended, begin - appended).find("base64") != std::string::npos;
      head = head.substr(0, appended) + "</VTKFile>";
    }
    const auto parsed = document_.load_buffer(head.data(), head.size());
    if (!parsed) fail(fmt::format("is not sound XML ({}, byte {})", parsed.description(), parsed.offset));
  }

  PointData read() {
    const auto root = document_.child("VTKFile");
    const std::string kind = root.attribute("type").as_string();
    if (kind != "PolyData" && kind != "UnstructuredGrid")
      fail(advised(fmt::format("type = \"{}\" (no particles, or parts of a parallel file)", kind),
                   "write one file of PolyData or UnstructuredGrid (.vtp, .vtu)"));
    wide_header_ = std::string_view(root.attribute("header_type").as_string()) == "UInt64";
    turned_ = (std::string_view(root.attribute("byte_order").as_string()) == "BigEndian") !=
              (std::endian::native == std::endian::big);
    const std::string_view compressor = root.attribute("compressor").as_string();
    packed_ = !compressor.empty();
    if (packed_ && compressor != "vtkZLibDataCompressor")
      fail(advised(fmt::format("compressor = \"{}\"", compressor), "write it with zlib, or not compressed"));
    PointData data;
    const auto grid = root.child(kind.c_str());
    for (const auto field : grid.child("FieldData").children("DataArray"))
      data.fields[field.attribute("Name").as_string()] = numbers(field);
    for (const auto piece : grid.children("Piece")) read_piece(piece, data);
    return data;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", file_, what));
  }

  void read_piece(const pugi::xml_node& piece, PointData& data) {
    const auto points = piece.child("Points").child("DataArray");
    const auto flat = points ? numbers(points) : std::vector<double>{};
    if (flat.size() != 3 * piece.attribute("NumberOfPoints").as_ullong())
      fail(fmt::format("Points holds {} numbers for {} points", flat.size(),
                       piece.attribute("NumberOfPoints").as_ullong()));
    const bool first = data.points.empty() && data.arrays.empty();
    for (std::size_t i = 0; i + 2 < flat.size(); i += 3)
      data.points.push_back({flat[i], flat[i + 1], flat[i + 2]});
    for (const auto node : piece.child("PointData").children("DataArray")) {
      const std::string name = node.attribute("Name").as_string();
      if (std::string_view(node.attribute("type").as_string()) == "String") continue;
      const std::size_t components = std::max(1u, node.attribute("NumberOfComponents").as_uint(1));
      auto found = std::find_if(data.arrays.begin(), data.arrays.end(),
                                [&](const auto& array) { return array.name == name; });
      if (found == data.arrays.end() && first) found = data.arrays.insert(found, {name, components, {}});
      if (found == data.arrays.end() || found->components != components)
        fail(fmt::format("array {} is not the same in every Piece", name));
      const auto values = numbers(node);
      found->values.insert(found->values.end(), values.begin(), values.end());
    }
  }

  std::vector<double> numbers(const pugi::xml_node& node) {
    const std::string format = node.attribute("format").as_string("ascii");
    if (format == "ascii") return numbers_in(node.text().as_string());
    if (format != "appended" && format != "binary") fail(fmt::format("format = \"{}\"", format));
    std::string bytes;
    if (format == "binary") {
      bytes = unpacked(from_base64(node.text().as_string()));
    } else {
      const std::size_t offset = node.attribute("offset").as_ullong();
      if (offset > appended_.size()) fail(fmt::format("offset {} lies behind the end", offset));
      const auto from = appended_.substr(offset);
      if (appended_base64_)
        bytes = unpacked(from_base64(from.substr(0, from.find('<'))));
      else
        bytes = unpacked(from);
    }
    return values_of(bytes, node.attribute("type").as_string());
  }

  std::vector<double> numbers_in(std::string_view text) const {
    std::vector<std::string_view> words;
    std::vector<double> values;
    for (std::size_t at = 0; at < text.size();) {
      const auto end = std::min(text.find('\n', at), text.size());
      split_words(text.substr(at, end - at), words);
      for (auto word : words) {
        if (word.starts_with('+')) word.remove_prefix(1);
        double value = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || stop != word.data() + word.size())
          fail(fmt::format("{} is not a number", word));
        values.push_back(value);
      }
      at = end + 1;
    }
    return values;
  }

  /// Number k of the header of a block.
  std::uint64_t header(std::string_view bytes, std::size_t k) const {
    const std::size_t size = wide_header_ ? 8 : 4;
    if (bytes.size() / size <= k) fail("an array is cut short");
    char number[8] = {};
    std::memcpy(number, bytes.data() + k * size, size);
    if (turned_) std::reverse(number, number + size);
    std::uint64_t wide = 0;
    std::uint32_t narrow = 0;
    std::memcpy(&wide, number, 8), std::memcpy(&narrow, number, 4);
    return wide_header_ ? wide : narrow;
  }

  std::string unpacked(std::string_view bytes) const {
    const std::size_t size = wide_header_ ? 8 : 4;
    const std::uint64_t first = header(bytes, 0);
    if (!packed_) {
      if (first > bytes.size() - size) fail("an array is cut short");
      return std::string(bytes.substr(size, first));
    }
    std::string all;
    if (first > bytes.size()) fail("an array is cut short");
    if (first == 0) return all;
    std::uint64_t at = (3 + first) * size;
    for (std::uint64_t block = 0; block < first; ++block) {
      const std::uint64_t packed = header(bytes, 3 + block), last = header(bytes, 2);
      const std::uint64_t whole = block + 1 == first && last > 0 ? last : header(bytes, 1);
      if (at > bytes.size() || packed > bytes.size() - at) fail("an array is cut short");
      const auto part = inflated(bytes.substr(at, packed), whole);
      if (!part) fail("a compressed array is damaged");
      all += *part;
      at += packed;
    }
    return all;
  }

  template <class T>
  std::vector<double> as(const std::string& bytes) const {
    std::vector<double> values(bytes.size() / sizeof(T));
    for (std::size_t k = 0; k < values.size(); ++k) {
      char number[sizeof(T)];
      std::memcpy(number, bytes.data() + k * sizeof(T), sizeof(T));
      if (turned_) std::reverse(number, number + sizeof(T));
      T value;
      std::memcpy(&value, number, sizeof(T));
      values[k] = static_cast<double>(value);
    }
    return values;
  }
  std::vector<double> values_of(const std::string& bytes, const std::string& type) const {
    if (type == "Float64") return as<double>(bytes);
    if (type == "Float32") return as<float>(bytes);
    if (type == "Int64") return as<std::int64_t>(bytes);
    if (type == "UInt64") return as<std::uint64_t>(bytes);
    if (type == "Int32") return as<std::int32_t>(bytes);
    if (type == "UInt32") return as<std::uint32_t>(bytes);
    if (type == "Int16") return as<std::int16_t>(bytes);
    if (type == "UInt16") return as<std::uint16_t>(bytes);
    if (type == "Int8") return as<std::int8_t>(bytes);
    if (type == "UInt8") return as<std::uint8_t>(bytes);
    fail(fmt::format("type = \"{}\" is not read", type));
  }

  const std::string& file_;
  pugi::xml_document document_;
  std::string_view appended_;
  bool appended_base64_ = false, wide_header_ = false, turned_ = false, packed_ = false;
};

}  // namespace

Snapshot import_vtk_xml(const std::string& file, std::string_view text, double radius_m) {
  return particles_of(file, XmlReader(file, text).read(), radius_m);
}

}  // namespace granrad
