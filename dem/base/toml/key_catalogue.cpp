#include "dem/base/toml/key_catalogue.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "dem/base/error.h"
#include "dem/base/toml/exploration.h"

namespace granrad {

namespace {

using Run = std::vector<KeyUse>;

/// More answers than this lead nowhere new: a run with one unusual answer, and one more below it.
constexpr std::size_t most_picks = 2;

std::string path_of(const KeyUse& use) {
  return use.table.empty() ? use.name : use.table + "." + use.name;
}

Run run_with(const std::function<void(TomlDocument&)>& read, const Exploration& how) {
  auto document = TomlDocument::exploring(how);
  try {
    read(document);
  } catch (const Error&) {
  }
  return document.uses();
}

std::vector<Run> explore(const std::function<void(TomlDocument&)>& read) {
  std::vector<Run> runs;
  for (const auto depth : {Exploration::bare, Exploration::tables, Exploration::keys}) {
    std::vector<Exploration> open{{depth, {}}};
    std::set<std::string> tried;  // by answer, the first time its question came up
    while (!open.empty()) {
      const Exploration how = open.back();
      open.pop_back();
      runs.push_back(run_with(read, how));
      if (how.picks.size() >= most_picks) continue;
      for (const KeyUse& use : runs.back())
        for (const auto& choice : use.choices) {
          if (how.picks.count(path_of(use)) || !tried.insert(path_of(use) + "=" + choice).second) continue;
          Exploration next = how;
          next.picks[path_of(use)] = choice;
          open.push_back(std::move(next));
        }
    }
  }
  return runs;
}

void merge(KnownKey& known, const KeyUse& use) {
  if (known.use.kind == KeyKind::text && use.kind == KeyKind::choice) {  // text: looked at before it was read
    known.use.kind = use.kind;
    known.use.choices = use.choices;
    known.use.fallback = use.fallback;
  }
  known.always_required = known.always_required && use.required;
  known.ever_required = known.ever_required || use.required;
  if (known.use.fallback && use.fallback && *known.use.fallback != *use.fallback) known.default_varies = true;
  known.use.rule.min = std::min(known.use.rule.min, use.rule.min);
  known.use.rule.max = std::max(known.use.rule.max, use.rule.max);
  if (!known.use.fallback) known.use.fallback = use.fallback;
  if (known.use.meaning.empty()) known.use.meaning = use.meaning;
  if (known.use.otherwise.empty()) known.use.otherwise = use.otherwise;
}

/// The answers to `question` in the runs that read `key`, and whether other runs had other answers.
std::string condition(const std::vector<Run>& runs, const KeyUse& key, const KeyUse& question) {
  std::set<std::string> with, without;
  for (const Run& run : runs) {
    std::string answer;
    bool read = false;
    for (const KeyUse& use : run) {
      if (use.table != key.table) continue;
      if (use.name == question.name && answer.empty()) answer = use.value;
      read = read || use.name == key.name;
    }
    if (!answer.empty()) (read ? with : without).insert(answer);
    if (answer.empty() && read) return "";
  }
  for (const auto& answer : with) without.erase(answer);
  if (without.empty() || with.empty()) return "";
  std::vector<std::string> words;
  for (const auto& choice : question.choices)
    if (with.count(choice))
      words.push_back(question.kind == KeyKind::boolean ? choice : fmt::format("\"{}\"", choice));
  return fmt::format("{} = {}", question.name, fmt::join(words, ", "));
}

void find_conditions(const std::vector<Run>& runs, KnownTable& table) {
  for (auto& key : table.keys) {
    std::vector<std::string> all;
    for (const auto& question : table.keys)
      if (question.use.kind == KeyKind::choice && question.use.name != key.use.name)
        if (const auto text = condition(runs, key.use, question.use); !text.empty()) all.push_back(text);
    key.when = fmt::format("{}", fmt::join(all, " and "));
  }
}

}  // namespace

std::vector<KnownTable> key_catalogue(const std::function<void(TomlDocument&)>& read) {
  const std::vector<Run> runs = explore(read);
  std::vector<KnownTable> tables{{}};
  const auto table_named = [&](const std::string& name) -> KnownTable& {
    const auto at = std::find_if(tables.begin(), tables.end(), [&](const auto& t) { return t.name == name; });
    if (at != tables.end()) return *at;
    return tables.emplace_back(KnownTable{name, {}, false, {}});
  };
  // Runs with most keys first, so that the order is that of a full file.
  for (auto run = runs.rbegin(); run != runs.rend(); ++run)
    for (const KeyUse& use : *run) {
      if (use.kind == KeyKind::table || use.kind == KeyKind::tables) {
        KnownTable& table = table_named(path_of(use));
        table.list = table.list || use.kind == KeyKind::tables;
        if (table.meaning.empty()) table.meaning = use.meaning;
        continue;
      }
      KnownTable& table = table_named(use.table);
      const auto same = [&](const KnownKey& key) { return key.use.name == use.name; };
      auto at = std::find_if(table.keys.begin(), table.keys.end(), same);
      if (at == table.keys.end()) at = table.keys.insert(at, {use, true, false, false, {}});
      merge(*at, use);
    }
  std::erase_if(tables, [](const KnownTable& table) { return table.keys.empty() && table.meaning.empty(); });
  for (auto& table : tables) find_conditions(runs, table);
  return tables;
}

}  // namespace granrad
