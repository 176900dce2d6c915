#include "dem/base/command_line.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "dem/base/error.h"
#include "dem/base/program.h"
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

/// Names of the subcommands of a command.
std::vector<std::string> subcommands_of(const CLI::App* command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command->get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

std::string guess(const std::string& word, const std::vector<std::string>& known) {
  const std::string meant = closest_word(word, known);
  return meant.empty() ? "" : fmt::format("; did you mean {}?", meant);
}

/// The innermost command that was named, and the first word after it that it does not know.
struct Asked {
  const CLI::App* command;
  std::string path;
  std::string unknown;                  ///< empty: every word is known
  std::vector<std::string> candidates;  ///< what could stand there
};

Asked read_words(const CLI::App& app, int argc, char** argv) {
  Asked asked{&app, app.get_name(), "", {}};
  for (int k = 1; k < argc; ++k) {
    const std::string word = std::string(argv[k]).substr(0, std::string(argv[k]).find('='));
    std::vector<std::string> known;
    if (word.starts_with("--")) {
      known = options_of(asked.command);
    } else if (!word.starts_with('-')) {
      known = subcommands_of(asked.command);
      if (known.empty()) continue;  // a positional argument
      if (knows(known, word)) {
        asked.command = asked.command->get_subcommand(word);
        asked.path += " " + word;
        continue;
      }
    }
    if (known.empty() || knows(known, word)) continue;
    asked.unknown = word;
    asked.candidates = known;
    return asked;
  }
  return asked;
}

/// "--to = vtk (must be vtp, dump, csv or npz)" of the parser's "--to: vtk not in {vtp,dump,csv,npz}", with a guess.
std::string choice_text(const std::string& said) {
  static const std::regex choice(R"(^(\S+): (.*) not in \{(.*)\}$)");
  std::smatch found;
  if (!std::regex_match(said, found, choice)) return said;
  std::vector<std::string> names;
  std::istringstream list(found[3].str());
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  const std::string last = names.back();
  names.pop_back();
  const std::string all = names.empty() ? last : fmt::format("{} or {}", fmt::join(names, ", "), last);
  names.push_back(last);
  return fmt::format("{} = {} (must be {}){}", found[1].str(), found[2].str(), all, guess(found[2], names));
}

/// What is wrong with the words of a command, and what could be meant.
std::string cause(const Asked& asked, const CLI::ParseError& error) {
  if (!asked.unknown.empty()) {
    const bool option = asked.unknown.starts_with("--");
    const std::string meant = guess(asked.unknown, asked.candidates);
    const std::string list =
        !option && meant.empty() ? fmt::format("; it has {}", fmt::join(asked.candidates, ", ")) : "";
    return fmt::format("{} is no {} of {}{}{}", asked.unknown, option ? "option" : "subcommand", asked.path,
                       meant, list);
  }
  if (const auto names = subcommands_of(asked.command); !names.empty())
    return fmt::format("{} needs a subcommand: {}", asked.path, fmt::join(names, ", "));
  return choice_text(error.what());
}

}  // namespace

void set_manners(CLI::App& app) {
  app.set_version_flag("--version",
                       fmt::format("{} {} ({})", app.get_name(), program_version(), program_git_sha()));
  app.set_help_all_flag("--help-all", "help of every subcommand");
  app.require_subcommand(1);
  app.formatter(std::make_shared<NarrowHelp>());
  app.get_formatter()->column_width(column_of_meaning);
}

int usage_exit(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  if (error.get_exit_code() == 0) return app.exit(error);  // help, version
  const Asked asked = read_words(app, argc, argv);
  fmt::print(stderr, "{}\nSee {} --help.\n", wrapped(cause(asked, error)), asked.path);
  return exit_bad_input;
}

int run_command(CLI::App& app, int argc, char** argv, const std::function<int(const std::string&)>& body) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return usage_exit(app, error, argc, argv);
  }
  return body(app.get_subcommands().front()->get_name());
}

}  // namespace granrad
