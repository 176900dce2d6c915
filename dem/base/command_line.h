#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace granrad {

/// What every program does: --version, --help-all, a subcommand is required, help within 80 columns. To be called before
/// subcommands are added: they inherit it.
void set_manners(CLI::App& app);

/// Reads the words of a command line, then gives the name of the subcommand to `body`, whose exit code is returned; that of
/// `usage_exit` where the words are wrong or ask for help.
int run_command(CLI::App& app, int argc, char** argv, const std::function<int(const std::string&)>& body);

/// Says what is wrong with the words of a command line (an unknown subcommand or option with the closest known one, a
/// value that is no choice, else the parser's words), then whose --help to see. Returns the exit code: 0 for help and
/// version, 2 otherwise.
int usage_exit(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);

}  // namespace granrad
