#pragma once
#include <filesystem>
#include <string>

#include "coupling/study/study.h"

namespace granrad {

/// What became of a case: NAME.case.json beside its folder.
struct CaseRecord {
  std::string identity, version;   ///< of its inputs (see command_of) and of the program
  std::string status = "waiting";  ///< waiting, running, finished, failed, interrupted
  std::string message;             ///< why it failed
  int code = 0;                    ///< exit code of its command
  double seconds = 0;
};

/// Version and commit of this program, as records state them.
std::string this_version();

/// Where the parts of a case are, below the study's folder.
struct CasePlace {
  std::filesystem::path folder, record, log;
};
CasePlace place_of(const std::filesystem::path& study, const StudyCase& one);

/// The record of a case; a fresh one when there is none that can be read.
CaseRecord read_case_record(const std::filesystem::path& file);
void write_case_record(const std::filesystem::path& file, const CaseRecord& record);

/// The words of a case's command, program first, and what its result depends on beside them.
struct CaseCommand {
  std::vector<std::string> words;
  std::string identity;
};

/// Reads the case's scene and names the files it takes from other cases; threads: 0, the program's choice. The
/// identity is a hash of the scene in force, the contents of every file that scene or command name, and the
/// command: with it and the version of the program equal, results are equal, and only then is a finished case
/// kept. Throws InputError (the scene, or a file that another case should have left).
CaseCommand command_of(const Study& study, const StudyCase& one, const std::filesystem::path& folder,
                       int threads);

}  // namespace granrad
