#include <fmt/core.h>

#include "dem/base/toml/toml_reader_state.h"

namespace granrad {

std::vector<Vec3> TomlTable::vec3_list(const Key& key, const NumberRule& each, std::size_t min_count) {
  node_->use(key, KeyKind::vectors, each, min_count > 0);
  return node_->entries<Vec3>(key.name, min_count, "points [x, y, z]",
                              [&](const toml::node& entry, const std::string& path) {
                                return node_->checked_vec3(entry, path, each).value_or(Vec3{});
                              });
}

std::vector<double> TomlTable::number_list(const Key& key, const NumberRule& each, std::size_t min_count) {
  node_->use(key, KeyKind::numbers, each, min_count > 0);
  return node_->entries<double>(key.name, min_count, "numbers",
                                [&](const toml::node& entry, const std::string& path) {
                                  return node_->checked_number(entry, path, each);
                                });
}

std::vector<std::string> TomlTable::string_list(const Key& key, std::size_t min_count) {
  node_->use(key, KeyKind::texts, {}, min_count > 0);
  return node_->entries<std::string>(
      key.name, min_count, "texts in quotes",
      [&](const toml::node& entry, const std::string& path) -> std::optional<std::string> {
        if (const auto* text = entry.as_string()) return text->get();
        node_->state->add_at(entry, path, "must be a text in quotes");
        return {};
      });
}

std::vector<std::vector<std::string>> TomlTable::string_lists(const Key& key, std::size_t min_count) {
  node_->use(key, KeyKind::text_lists).required = min_count > 0;
  return node_->entries<std::vector<std::string>>(
      key.name, min_count, "lists of texts in quotes",
      [&](const toml::node& entry, const std::string& path) -> std::optional<std::vector<std::string>> {
        std::vector<std::string> texts;
        const toml::array* inner = entry.as_array();
        for (std::size_t m = 0; inner && m < inner->size(); ++m)
          if (const auto* text = (*inner)[m].as_string()) texts.push_back(text->get());
        if (!inner || texts.size() != inner->size())
          node_->state->add_at(entry, path, "must be a list of texts in quotes");
        return texts;
      });
}

std::vector<std::string> TomlTable::value_list(const Key& key, std::size_t min_count) {
  node_->use(key, KeyKind::values).required = min_count > 0;
  return node_->entries<std::string>(
      key.name, min_count, "numbers, texts or booleans",
      [&](const toml::node& entry, const std::string& path) -> std::optional<std::string> {
        if (const auto* text = entry.as_string()) return text->get();
        if (const auto* whole = entry.as_integer()) return fmt::format("{}", whole->get());
        if (const auto* real = entry.as_floating_point()) return fmt::format("{}", real->get());
        if (const auto* truth = entry.as_boolean()) return truth->get() ? "true" : "false";
        node_->state->add_at(entry, path, "must be a number, a text in quotes, true or false");
        return {};
      });
}

}  // namespace granrad
