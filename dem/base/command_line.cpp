#include "dem/base/command_line.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "dem/base/error.h"
#include "dem/base/suggestion.h"

namespace granrad {

namespace {

constexpr std::size_t widest = 80, column_of_meaning = 30;

/// One line of help in several, the later ones below the meaning of an option.
std::string wrapped(const std::string& line) {
  if (line.size() <= widest) return line;
  const std::size_t indent = line.starts_with("  ") ? column_of_meaning : 0;
  std::string out, row;
  std::istringstream words(line.substr(line.find_first_not_of(' ')));
  row = line.substr(0, line.find_first_not_of(' '));
  if (indent > 0 && line.size() > indent && row.size() < indent) {  // the option itself keeps its place
    const std::size_t gap = line.find("  ", row.size());
    if (gap != std::string::npos && gap < indent) {
      row = line.substr(0, indent);
      words.str(line.substr(indent));
      words.clear();
    }
  }
  bool first = true;
  for (std::string word; words >> word;) {
    if (!first && row.size() + 1 + word.size() > widest) {
      out += row + "\n";
      row = std::string(indent, ' ') + word;
      continue;
    }
    if (!first && !row.ends_with(' ')) row += ' ';
    row += word;
    first = false;
  }
  return out + row;
}

class NarrowHelp : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::istringstream help(CLI::Formatter::make_help(app, name, mode));
    std::string out;
    for (std::string line; std::getline(help, line);) out += wrapped(line) + "\n";
    return out;
  }
};

/// Long names of the options a command takes, its parents' among them where words fall through to them.
std::vector<std::string> options_of(const CLI::App* command) {
  std::vector<std::string> names;
  for (const CLI::App* app = command; app; app = app->get_parent())
    for (const CLI::Option* option : app->get_options())
      for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

bool knows(const std::vector<std::string>& names, const std::string& word) {
  return std::find(names.begin(), names.end(), word) != names.end();
}

/// "--ray is no option of vfgen trace; did you mean --rays?" for the first word that is nothing known; "" without any.
std::string hint(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  std::string path = app.get_name();
  for (int k = 1; k < argc; ++k) {
    const std::string word = std::string(argv[k]).substr(0, std::string(argv[k]).find('='));
    std::vector<std::string> known;
    if (word.starts_with("--")) {
      known = options_of(command);
    } else if (!word.starts_with('-')) {
      for (const CLI::App* sub : command->get_subcommands([](const CLI::App*) { return true; }))
        known.push_back(sub->get_name());
      if (known.empty()) continue;  // a positional argument
      if (knows(known, word)) {
        command = command->get_subcommand(word);
        path += " " + word;
        continue;
      }
    }
    if (known.empty() || knows(known, word)) continue;
    const std::string meant = closest_word(word, known);
    return fmt::format("{} is no {} of {}{}", word, word.starts_with("--") ? "option" : "subcommand", path,
                       meant.empty() ? "" : fmt::format("; did you mean {}?", meant));
  }
  return "";
}

}  // namespace

void set_manners(CLI::App& app) {
  app.formatter(std::make_shared<NarrowHelp>());
  app.get_formatter()->column_width(column_of_meaning);
}

int usage_exit(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  if (app.exit(error) == 0) return exit_ok;
  if (const std::string text = hint(app, argc, argv); !text.empty()) fmt::print(stderr, "{}\n", text);
  return exit_bad_input;
}

}  // namespace granrad
