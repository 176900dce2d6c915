#include <fmt/core.h>
#include <glob.h>

#include <algorithm>

#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/case_inputs.h"
#include "coupling/study/case_record.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

fs::path program(const std::string& name) {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (name == "granrun" && !error) return self;
  if (!error && fs::exists(self.parent_path() / name)) return self.parent_path() / name;
  return name;
}

std::string hash(const std::string& text) {
  return fmt::format("{:016x}", text_hash(text));
}

/// Files of the cases of `points`: frames of the second half of a run, the view factors of a trace.
std::vector<fs::path> files_from(const Study& study, const StudyCase& one, const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& point : one.from)
    for (const auto* other : study.of_point(point)) {
      const fs::path where = folder / other->name;
      if (other->kind == StudyKind::run) {
        const auto frames = CaseFolder(where).frames();
        for (std::size_t k = (frames.size() + 1) / 2; k < frames.size(); ++k) files.push_back(frames[k].file);
      } else if (other->kind == StudyKind::trace) {
        for (const auto& entry : fs::directory_iterator(where))
          if (entry.path().extension() == ".h5") files.push_back(entry.path());
      }
    }
  std::sort(files.begin(), files.end());
  if (files.empty() && !one.from.empty())
    throw InputError(
        advised("the cases it takes files from have left none", "name runs for a trace, traces for a fit"));
  return files;
}

std::string last_frame(const Study& study, const StudyCase& one, const fs::path& folder) {
  const auto frames = CaseFolder(folder / study.of_point(one.start).front()->name).frames();
  if (frames.empty()) throw InputError(fmt::format("start = {}: that case has no frames", one.start));
  return fs::absolute(frames.back().file).string();
}

std::vector<std::string> overrides_of(const Study& study, const StudyCase& one, const fs::path& folder) {
  std::vector<std::string> all = {fmt::format("scene.name=\"{}\"", one.name)};
  if (!one.start.empty()) all.push_back("particles.file=" + last_frame(study, one, folder));
  all.insert(all.end(), one.set.begin(), one.set.end());
  return all;
}

/// Name and hash of the contents of every file that a text of the scene, or a pattern, names.
std::string contents(const std::vector<std::string>& texts, const fs::path& from) {
  std::string all;
  for (const auto& text : texts) {
    if (text.empty() || text.find('\n') != std::string::npos) continue;
    glob_t found{};
    if (glob((from / text).c_str(), GLOB_NOSORT, nullptr, &found) == 0)
      for (std::size_t k = 0; k < found.gl_pathc; ++k)
        if (fs::is_regular_file(found.gl_pathv[k]))
          all += fmt::format("{} {}\n", text, hash(read_text_file(found.gl_pathv[k])));
    globfree(&found);
  }
  return all;
}

void add(std::vector<std::string>& words, std::initializer_list<std::string> more) {
  words.insert(words.end(), more);
}

CaseCommand scene_command(const Study& study, const StudyCase& one, const fs::path& folder) {
  const auto overrides = overrides_of(study, one, folder);
  const Case c = read_case(one.scene, overrides, one.unset);
  CaseCommand command;
  add(command.words, {program("granrun").string(), to_string(one.kind)});
  if (one.kind == StudyKind::measure) add(command.words, {"conductivity"});
  add(command.words, {one.scene.string(), "-o", (folder / one.name).string()});
  if (one.kind == StudyKind::run) add(command.words, {"--resume"});
  for (const auto& text : overrides) add(command.words, {"--set", text});
  for (const auto& key : one.unset) add(command.words, {"--unset", key});
  const auto texts = TomlDocument::from_string(c.effective_text, "scene").texts();
  command.identity = c.effective_text + contents(texts, fs::absolute(one.scene).parent_path());
  return command;
}

CaseCommand vfgen_command(const Study& study, const StudyCase& one, const fs::path& folder) {
  CaseCommand command;
  add(command.words, {program("vfgen").string(), to_string(one.kind)});
  std::vector<std::string> names;
  for (const auto& file : files_from(study, one, folder)) names.push_back(file.string());
  command.words.insert(command.words.end(), names.begin(), names.end());
  const char* result = one.kind == StudyKind::trace ? "view_factors.h5" : "table.toml";
  add(command.words, {"-o", (folder / one.name / result).string()});
  command.identity = contents(names, "");
  return command;
}

/// {folder} in a word is the whole path of the case's folder, {bin} that of our programs. The program is found beside the
/// study, beside ours, or by PATH.
CaseCommand other_command(const Study& study, const StudyCase& one, const fs::path& folder) {
  if (one.options.empty())
    throw InputError("has no command; give options = [\"program\", \"argument\", ...]");
  CaseCommand command;
  for (std::string word : one.options) {
    for (std::size_t at; (at = word.find("{folder}")) != std::string::npos;)
      word.replace(at, 8, fs::absolute(folder / one.name).string());
    for (std::size_t at; (at = word.find("{bin}")) != std::string::npos;)
      word.replace(at, 5, program("granrun").parent_path().string());
    command.words.push_back(word);
  }
  auto& first = command.words.front();
  const fs::path beside = study.file.parent_path() / first;
  first = (first.find('/') != std::string::npos && fs::exists(beside) ? beside : program(first)).string();
  command.identity = contents(command.words, study.file.parent_path());
  return command;
}

}  // namespace

CaseCommand command_of(const Study& study, const StudyCase& one, const fs::path& folder, int threads) {
  CaseCommand command;
  switch (one.kind) {
    case StudyKind::run:
    case StudyKind::validate:
    case StudyKind::measure:
      command = scene_command(study, one, folder);
      break;
    case StudyKind::trace:
    case StudyKind::fit:
      command = vfgen_command(study, one, folder);
      break;
    case StudyKind::command:
      command = other_command(study, one, folder);
      break;
  }
  if (one.kind != StudyKind::command)
    command.words.insert(command.words.end(), one.options.begin(), one.options.end());
  std::string all = fmt::format("{}\n{}", to_string(one.kind), command.identity);
  for (const auto& word : one.options) all += word + "\n";
  command.identity = hash(all);
  if (threads > 0 && one.kind != StudyKind::fit && one.kind != StudyKind::command)
    add(command.words, {"--threads", fmt::format("{}", threads)});
  return command;
}

}  // namespace granrad
