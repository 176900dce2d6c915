// Requirement: a study runs every case once and knows a case by its scene, inputs and version: what is stale runs
// anew, what is impossible fails alone and is named, and a killed study loses nothing.
#include <signal.h>

#include <chrono>
#include <thread>

#include "small_study.h"

using namespace granrad;
using namespace granrad::cli;

TEST(GranrunStudy, EveryKindOfVariationBecomesOneRow) {
  SmallStudy study;
  const std::string text =
      "[study]\nscene = \"plug.toml\"\n"
      "[[vary]]\nkeys = [\"walls.y_min.temperature_K\", \"walls.y_max.temperature_K\"]\nname = \"Tw\"\n"
      "values = [700, 1000]\n"
      "[[vary]]\nnames = [\"small\", \"large\"]\nset = [[\"particles.diameter_m='0.6 mm'\", \"dem.step_s=5e-6\"], "
      "[\"particles.diameter_m='0.8 mm'\"]]\n"
      "[[group]]\nname = \"flow\"\nunset = [\"feed.velocity_m_s\"]\nset = [\"feed.mass_flow_kg_s=0.0005\"]\n"
      "seeds = [1, 2]\n[[group.case]]\nname = \"slow\"\n"
      "[[group]]\nname = \"frozen\"\n[[group.case]]\nname = \"goes_on\"\nstart = \"Tw-700_small\"\n"
      "set = [\"dem.engine=none\", \"particles.diameter_m='0.6 mm'\"]\nunset = [\"dem.step_s\"]\n"
      "[[group]]\nname = \"fine\"\n[[group.case]]\nname = \"rows\"\nset = [\"output.every_s=0.0004\", \"output.average_from_s=0.006\"]\n"
      "[[probe]]\nname = \"T_at_wall\"\naxis = \"y\"\nfrom_diameters = 0\nto_diameters = 1\n"
      "[[probe]]\nname = \"N\"\nwhat = \"count\"\naxis = \"y\"\nfrom_m = 0\nto_m = 1\n"
      "[[column]]\nname = \"double_h\"\nformula = \"2 * h_wp_W_m2K\"\n";
  const auto outcome = study.run(text);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto table = rows(study.folder / "study.csv");
  ASSERT_EQ(table.size(), 7u);
  EXPECT_EQ(table[0].at("case"), "Tw-700_small");
  for (const char* wall : {"walls.y_min.temperature_K", "walls.y_max.temperature_K"}) {
    EXPECT_EQ(table[0].at(wall), "700") << "both keys change together";
    EXPECT_EQ(table[3].at(wall), "1000");
  }
  EXPECT_EQ(table[1].at("particles.diameter_m"), "'0.8 mm'");
  EXPECT_EQ(table[4].at("case"), "flow/slow");
  EXPECT_EQ(table[4].at("replicates"), "2");
  EXPECT_GT(std::stod(table[4].at("h_wp_W_m2K_stderr")), 0) << "the scatter between seeds";
  EXPECT_NEAR(std::stod(table[4].at("mass_flow_in_kg_s")), 0.0005, 0.0005);
  EXPECT_EQ(table[5].at("status"), "finished") << "begins with the last frame of another case";
  // Planted: Nu_d h_rad / h_wp with all three taken as independent: an error 36 times as large.
  // Means over the window that the scene asks for, as in results.json.
  const auto results = content(study.folder / "fine" / "rows" / "results.json");
  EXPECT_NE(results.find("\"h_wp_W_m2K\": {\n   \"mean\": " + table[6].at("h_wp_W_m2K").substr(0, 6)),
            std::string::npos)
      << table[6].at("h_wp_W_m2K") << "\n"
      << results;
  EXPECT_GT(std::stod(table[6].at("Nu_rad_stderr")), 0);
  EXPECT_EQ(table[6].at("Nu_rad_stderr"), table[6].at("Nu_d_rad_stderr"));
  for (const auto& row : table) {
    EXPECT_NEAR(std::stod(row.at("double_h")), 2 * std::stod(row.at("h_wp_W_m2K")), 1e-5);
    EXPECT_NEAR(std::stod(row.at("share_ss_pct")) + std::stod(row.at("share_sfs_pct")) +
                    std::stod(row.at("share_rad_pct")),
                100, 1e-6);
  }
  // Of the last frame: spheres beside the hot wall are hotter than the mean, and all of the box are counted.
  EXPECT_GT(std::stod(table[0].at("T_at_wall")), std::stod(table[0].at("final_mean_temperature_K")));
  EXPECT_NEAR(std::stod(table[0].at("N")), std::stod(table[0].at("region_particle_count")), 3);
  EXPECT_NE(content(study.folder / "report.html").find("Every case"), std::string::npos);
}

// Planted: identity without the scene: the second study keeps the old rows.
TEST(GranrunStudy, AChangedSceneInputOrVersionRunsAnewAndKeepsTheOld) {
  SmallStudy study;
  ASSERT_EQ(study.run(two_cases).code, 0);
  const auto first = rows(study.folder / "study.csv");
  const auto history = study.folder / "emissivity-1" / "history.csv";
  const auto written = fs::last_write_time(history);
  const auto again = study.run(two_cases);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(fs::last_write_time(history), written) << "finished cases are not run again";

  study.write("plug.toml", edited(content(study.scene), "temperature_K = 1000", "temperature_K = 700"));
  const auto changed = study.run(two_cases);
  ASSERT_EQ(changed.code, 0) << changed.err;
  const auto second = rows(study.folder / "study.csv");
  for (int k = 0; k < 2; ++k)
    EXPECT_LT(std::stod(second[k].at("Q_rad_W")), 0.5 * std::stod(first[k].at("Q_rad_W")))
        << "the hot walls cooled";
  EXPECT_NE(changed.err.find("case emissivity-1: its scene, inputs or the version"), std::string::npos)
      << changed.err;
  EXPECT_TRUE(fs::exists(study.folder / "superseded"));

  // The contents of a file that the scene names count as well.
  fs::copy(fs::path(GRANRAD_SOURCE_DATA) / "correlations" / "li_2024_printed.toml",
           study.root / "table.toml");
  const std::string with_table = two_cases +
                                 "[[case]]\nname = \"table\"\nset = [\"radiation.source=correlation\", "
                                 "\"radiation.table=table.toml\"]\n";
  study.write("plug.toml", edited(content(study.scene), "rays = 500\n", ""));
  ASSERT_EQ(study.run(with_table).code, 0);
  const auto record = content(study.folder / "table.case.json");
  study.write("table.toml", content(study.root / "table.toml") + "# read once more\n");
  ASSERT_EQ(study.run(with_table).code, 0);
  EXPECT_NE(content(study.folder / "table.case.json"), record);
  // ... and so does the version of the program, unless told otherwise.
  const auto file = study.folder / "table.case.json";
  study.write("out/table.case.json", edited(content(file), "\"version\": \"0", "\"version\": \"old 0"));
  EXPECT_EQ(study.run(with_table, "--any-version").err.find("case table"), std::string::npos);
  EXPECT_NE(study.run(with_table).err.find("case table: finished"), std::string::npos);
}

// Planted: a throw of the first bad case ends the study.
TEST(GranrunStudy, AnImpossibleCaseFailsAloneAndIsNamed) {
  SmallStudy study;
  const auto outcome = study.run(
      "[study]\nscene = \"plug.toml\"\n[[vary]]\nkey = \"material.emissivity\"\nvalues = [2, 0.4]\n"
      "[[case]]\nname = \"too_long_a_step\"\nset = [\"dem.step_s=1e-3\"]\n"
      "[[case]]\nname = \"child\"\nstart = \"too_long_a_step\"\n[[case]]\nname = \"good\"\nset = []\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("case emissivity-2: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("case too_long_a_step: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("case child: not run"), std::string::npos) << outcome.err;
  std::map<std::string, std::string> status;
  for (const auto& row : rows(study.folder / "study.csv")) status[row.at("case")] = row.at("status");
  EXPECT_EQ(status["emissivity-0.4"], "finished");
  EXPECT_EQ(status["good"], "finished");
  EXPECT_EQ(status["emissivity-2"], "failed");
  EXPECT_EQ(status["too_long_a_step"], "failed");

  // Nothing possible: nothing written.
  study.write("plug.toml", edited(content(study.scene), "radiation", "radiaton"));
  study.folder = study.root / "none";
  EXPECT_EQ(study.run(two_cases).code, 2);
  EXPECT_FALSE(fs::exists(study.folder));
}

TEST(GranrunStudy, AnyNumberOfJobsFindsTheSame) {
  SmallStudy one, three;
  const std::string text = "seeds = [1, 2]\n";
  const auto study = edited(two_cases, "[[vary]]", text + "[[vary]]");
  one.write("study.toml", study);
  ASSERT_EQ(granrun(one, "study " + one.file.string() + " -q --jobs 1 -o " + one.folder.string()).code, 0);
  three.write("study.toml", study);
  ASSERT_EQ(granrun(three, "study " + three.file.string() + " -q --jobs 3 -o " + three.folder.string()).code,
            0);
  const auto a = rows(one.folder / "study.csv"), b = rows(three.folder / "study.csv");
  ASSERT_EQ(a.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(a[k].at("replicates"), "2");
    for (const auto& [name, value] : a[k])
      if (name != "seconds") {
        EXPECT_EQ(value, b[k].at(name)) << name;
      }
  }
}

TEST(GranrunStudy, AKilledStudyGoesOnWhereItWas) {
  SmallStudy study;
  study.write("plug.toml", edited(small_plug, "end_time_s = 0.04", "end_time_s = 0.2"));
  study.write("study.toml", two_cases);
  const std::vector<std::string> words = {"study", study.file.string(), "-o", study.folder.string(), "--jobs",
                                          "2"};
  for (const int number : {SIGTERM, SIGKILL}) {
    const auto frames = study.folder / "emissivity-0.4" / "frames" /
                        (number == SIGTERM ? "f_000000800.hdf" : "f_000003200.hdf");
    const pid_t child = start_granrun(words);
    for (int k = 0; k < 2000 && !fs::exists(frames); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(fs::exists(frames));
    kill(child, number);
    int state = 0;
    waitpid(child, &state, 0);
    EXPECT_EQ(exit_code(state), 128 + number);
  }
  const auto outcome = study.run(two_cases);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(content(study.folder / "emissivity-0.4.log").find("resumed from"), std::string::npos);
  const auto whole = study.root / "whole";
  ASSERT_EQ(granrun(study, "run " + study.scene.string() +
                               " -q --set material.emissivity=0.4 --set "
                               "'scene.name=\"emissivity-0.4\"' -o " +
                               whole.string())
                .code,
            0);
  EXPECT_EQ(content(whole / "history.csv"), content(study.folder / "emissivity-0.4" / "history.csv"))
      << "as if it had never been killed";
}

TEST(GranrunStudy, JobFilesRunTheSameCases) {
  SmallStudy study;
  const auto listed = study.run(two_cases, "--list");
  ASSERT_EQ(listed.code, 0) << listed.err;
  EXPECT_FALSE(fs::exists(study.folder / "emissivity-1"));
  std::stringstream jobs(content(study.folder / "jobs.txt"));
  int count = 0;
  for (std::string line; std::getline(jobs, line); ++count)
    EXPECT_EQ(std::system(("PATH=" + std::string(GRANRAD_BIN_DIR) + ":$PATH; " + line + " -q").c_str()), 0)
        << line;
  EXPECT_EQ(count, 2);
  const auto gathered = study.run(two_cases);
  EXPECT_EQ(gathered.err.find("finished in"), std::string::npos) << "all are there: " << gathered.err;
  for (const auto& row : rows(study.folder / "study.csv")) EXPECT_EQ(row.at("status"), "finished");
  EXPECT_NE(content(study.folder / "slurm_array.sh").find("--array=1-2"), std::string::npos);
  // A task of the array, as Slurm starts it, runs its line: a record taken away comes back.
  fs::remove(study.folder / "emissivity-1.case.json");
  EXPECT_EQ(std::system(("SLURM_ARRAY_TASK_ID=2 PATH=" + std::string(GRANRAD_BIN_DIR) + ":$PATH bash " +
                         (study.folder / "slurm_array.sh").string() + " >/dev/null 2>&1")
                            .c_str()),
            0);
  EXPECT_TRUE(fs::exists(study.folder / "emissivity-1.case.json"));
}

// snakemake brings some 70 packages: ./do test-long has it.
TEST(GranrunStudy, LongSnakefileRunsEveryCase) {
  if (std::system("command -v snakemake >/dev/null 2>&1") != 0) GTEST_SKIP() << "no snakemake here";
  SmallStudy study;
  ASSERT_EQ(study.run(two_cases, "--list").code, 0);
  EXPECT_EQ(std::system(("cd " + study.folder.string() + " && PATH=" + GRANRAD_BIN_DIR +
                         ":$PATH snakemake --cores 1 -q >/dev/null 2>&1")
                            .c_str()),
            0);
  for (const auto& row : rows(study.folder / "study.csv")) EXPECT_EQ(row.at("status"), "finished");
}

// Two studies in one folder share its cases: each case is computed by one of them, and both end well.
// To plant: no lock on a case (both compute it, and one finds the folder in use).
TEST(GranrunStudy, TwoAtOnceShareTheCases) {
  SmallStudy study;
  study.write("study.toml", two_cases);
  const auto start = [&] {
    return start_granrun({"study", study.file.string(), "-o", study.folder.string(), "--jobs", "2"});
  };
  const pid_t first = start(), second = start();
  for (const pid_t one : {first, second}) {
    int status = 0;
    waitpid(one, &status, 0);
    EXPECT_EQ(exit_code(status), 0);
  }
  const auto together = rows(study.folder / "study.csv");
  ASSERT_EQ(together.size(), 2u);
  for (const auto& row : together) EXPECT_EQ(row.at("status"), "finished");
  const fs::path shared = study.folder;
  study.folder = study.root / "alone";
  ASSERT_EQ(study.run(two_cases).code, 0);
  for (const auto& entry : fs::directory_iterator(study.folder)) {
    if (!entry.is_directory()) continue;
    EXPECT_EQ(content(entry.path() / "history.csv"),
              content(shared / entry.path().filename() / "history.csv"));
  }
}
