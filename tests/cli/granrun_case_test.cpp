// Requirement: the folder of a case belongs to one process, survives whatever stops a run, and tells where it
// came from.
#include <signal.h>
#include <sys/file.h>

#include <chrono>
#include <thread>

#include "coupling/simulation/history.h"
#include "granrun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

std::string run_line(const fs::path& scene, const fs::path& folder, const std::string& more = "") {
  return "run " + scene.string() + " -o " + folder.string() + " " + more;
}

void wait_for(const fs::path& file) {
  for (int wait = 0; wait < 1000 && !fs::exists(file); ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_TRUE(fs::exists(file)) << file;
}

int ended(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return exit_code(status);
}

/// All files of a folder with their content.
std::map<std::string, std::string> everything(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder)] = content(entry.path());
  return files;
}

}  // namespace

// Catches a lock that is not taken, or that outlives its process (to plant: no flock, both runs went on).
TEST(GranrunCase, BelongsToOneProcess) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto folder = scratch.root / "case";
  const pid_t first =
      start_granrun({"run", scene.string(), "-q", "-o", folder.string(), "--set", "scene.end_time_s=100"});
  wait_for(folder / "frames" / "f_000000800.hdf");
  const auto second = granrun(scratch, run_line(scene, folder, "--resume --set scene.end_time_s=100"));
  EXPECT_EQ(second.code, 2);
  EXPECT_NE(second.err.find("in use by process " + std::to_string(first)), std::string::npos) << second.err;
  kill(first, SIGKILL);
  EXPECT_EQ(ended(first), 128 + SIGKILL);
  EXPECT_EQ(
      granrun(scratch, run_line(scene, folder, "-q --resume --set scene.end_time_s=100 --walltime 0:0:0"))
          .code,
      75);
  EXPECT_FALSE(fs::exists(folder / ".lock"));
}

TEST(GranrunCase, AFinishedOneIsLeftAsItIs) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto folder = scratch.root / "case";
  ASSERT_EQ(granrun(scratch, run_line(scene, folder, "-q")).code, 0);
  const auto before = everything(folder);
  const auto again = granrun(scratch, run_line(scene, folder, "--resume"));
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.err.find("finished already"), std::string::npos) << again.err;
  EXPECT_TRUE(before == everything(folder));
  const auto earlier = granrun(scratch, run_line(scene, folder, "--resume --set scene.end_time_s=0.01"));
  EXPECT_EQ(earlier.code, 2) << earlier.err;
  EXPECT_TRUE(before == everything(folder));
}

// What is there when a run is killed before its first frame.
TEST(GranrunCase, StartsWhereAKilledRunHadOnlyBegun) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  for (const char* resume : {"", "--resume"}) {
    const auto folder = scratch.root / (std::string("case") + resume);
    fs::create_directories(folder / "frames");
    std::ofstream(folder / "scene.toml") << "[scene]";
    std::ofstream(folder / "frames" / "f_000000000.hdf.tmp") << "half";
    std::ofstream(folder / "run.json.tmp123") << "{";
    ASSERT_EQ(granrun(scratch, run_line(scene, folder, std::string("-q ") + resume)).code, 0);
    for (const auto& [name, text] : everything(folder))
      EXPECT_EQ(name.find(".tmp"), std::string::npos) << name;
  }
}

TEST(GranrunCase, KeepsItsHistoryWhenNoFrameCanBeRead) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto folder = scratch.root / "case";
  ASSERT_EQ(granrun(scratch, run_line(scene, folder, "-q")).code, 0);
  for (const auto& entry : fs::directory_iterator(folder / "frames"))
    std::ofstream(entry.path(), std::ios::trunc) << "no frame";
  const auto before = everything(folder);
  const auto again = granrun(scratch, run_line(scene, folder, "-q --resume --set scene.end_time_s=0.05"));
  EXPECT_EQ(again.code, 3) << again.err;
  EXPECT_NE(again.err.find("no frame of"), std::string::npos) << again.err;
  EXPECT_TRUE(before == everything(folder));
  fs::remove_all(folder / "frames");
  EXPECT_EQ(granrun(scratch, run_line(scene, folder, "-q --resume --set scene.end_time_s=0.05")).code, 3);
  EXPECT_EQ(content(folder / "history.csv"), before.at("history.csv"));
}

// A finished case is worth its last frame. Planted, seen: its record alone believed, the damaged frame stays.
TEST(GranrunCase, AFinishedOneWithADamagedLastFrameIsMadeWholeAgain) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto folder = scratch.root / "case";
  ASSERT_EQ(granrun(scratch, run_line(scene, folder, "-q")).code, 0);
  const auto before = everything(folder);
  std::string last;
  for (const auto& [name, text] : before)
    if (name.starts_with("frames/")) last = name;
  const auto other =
      scratch.write("other.toml", edited(small_plug, "conductivity_W_mK = 33\n", "conductivity_W_mK = 32\n"));
  ASSERT_EQ(granrun(scratch, run_line(other, scratch.root / "other", "-q")).code, 0);
  for (const std::string& damage : {before.at(last).substr(0, 20000), std::string("no frame"), std::string(),
                                    content(scratch.root / "other" / last)}) {
    std::ofstream(folder / last, std::ios::trunc | std::ios::binary) << damage;
    const auto again = granrun(scratch, run_line(scene, folder, "-q --resume"));
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.err.find("trying the frame before"), std::string::npos) << again.err;
    for (const std::string& name : {last, std::string("history.csv"), std::string("walls.csv")})
      EXPECT_TRUE(content(folder / name) == before.at(name)) << name;
  }
}

// Planted, seen: only the last row looked at.
TEST(GranrunCase, SaysWhereRowsOfItsHistoryAreMissing) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto folder = scratch.root / "case";
  ASSERT_EQ(granrun(scratch, run_line(scene, folder, "-q")).code, 0);
  std::istringstream history(content(folder / "history.csv"));
  std::ofstream out(folder / "history.csv", std::ios::trunc);
  std::string line;
  for (int k = 0; std::getline(history, line); ++k)
    if (k != 3) out << line << "\n";
  out.close();
  const auto again = granrun(scratch, run_line(scene, folder, "--resume --set scene.end_time_s=0.05"));
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.err.find("are missing"), std::string::npos) << again.err;
}

// Planted, seen: nothing said of what the region cannot hold.
TEST(GranrunCase, AFeedThatFindsNoRoomSaysSo) {
  Scratch scratch;
  const auto hopper = [&](const std::string& keys) {
    const std::string plug =
        small_plug.substr(small_plug.find("[feed]"), small_plug.find("[dem]") - small_plug.find("[feed]"));
    const auto text =
        edited(small_plug, plug,
               "[feed]\nkind = \"hopper\"\nvelocity_m_s = 0.1\nremove_below_m = -0.001\n" + keys +
                   "\n[feed.fill_region]\nmin_m = [0, 0, 0.002]\nmax_m = [0.004, 0.003, 0.006]\n");
    const auto out = granrun(scratch, run_line(scratch.write("hopper.toml", text), scratch.root / "case",
                                               "--set scene.end_time_s=0.004"));
    EXPECT_EQ(out.code, 0) << out.err;
    fs::remove_all(scratch.root / "case");
    return out.err;
  };
  const auto too_many = hopper("particle_count = 5000");
  EXPECT_NE(too_many.find("feed.particle_count = 5000: "), std::string::npos) << too_many;
  EXPECT_NE(too_many.find("were due and found no room"), std::string::npos) << too_many;
  const auto too_fast = hopper("particle_count = 5000\nrate_1_s = 1e6");
  EXPECT_NE(too_fast.find("were due and found no room"), std::string::npos) << too_fast;
  EXPECT_EQ(hopper("particle_count = 20").find("room"), std::string::npos);
}

TEST(GranrunCase, AFolderThatCannotBeMadeSaysWhy) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto refused = granrun(scratch, run_line(scene, "/proc/granrad", "-q"));
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("/proc/granrad: cannot be created"), std::string::npos) << refused.err;
}

TEST(GranrunCase, HangUpAndUserSignalSaveACheckpoint) {
  Scratch scratch;
  const auto scene =
      scratch.write("plug.toml", edited(small_plug, "frames_every_s = 0.008", "frames_every_s = 40"));
  const auto folder = scratch.root / "case";
  const pid_t child =
      start_granrun({"run", scene.string(), "-q", "-o", folder.string(), "--set", "scene.end_time_s=100"});
  wait_for(folder / "frames" / "f_000000000.hdf");
  for (int wait = 0; wait < 500 && last_frame(folder).filename() == "f_000000000.hdf"; ++wait) {
    kill(child, SIGUSR1);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_NE(last_frame(folder).filename(), "f_000000000.hdf");
  EXPECT_EQ(kill(child, 0), 0) << "the run goes on";
  kill(child, SIGHUP);
  EXPECT_EQ(ended(child), 129);
}

// Catches paths of the folder it was first run in (to plant: effective_text in the place of portable_text).
TEST(GranrunCase, ItsSceneRunsAnywhere) {
  Scratch scratch;
  scratch.write("bed.csv", "x,y,z,radius\n0.002,0.0015,0.002,0.0004\n0.001,0.0015,0.002,0.0004\n");
  auto text =
      edited(small_plug, "temperature_K = 300\n[box]", "temperature_K = 300\nfile = \"bed.csv\"\n[box]");
  const auto feed = text.find("[feed]"), dem = text.find("[dem]");
  text.erase(feed, dem - feed);
  const auto scene = scratch.write("bed.toml", text);
  const auto folder = scratch.root / "case", moved = scratch.root / "moved";
  ASSERT_EQ(granrun(scratch, run_line(scene, folder, "-q")).code, 0);
  fs::rename(folder, moved);
  fs::remove(scratch.root / "bed.csv");
  const auto again = granrun(scratch, run_line(moved / "scene.toml", scratch.root / "again", "-q"));
  ASSERT_EQ(again.code, 0) << again.err;
  expect_same_case(moved, scratch.root / "again");
  // A changed input is another scene, even under the same name.
  scratch.write("bed.csv", "x,y,z,radius\n0.002,0.0015,0.002,0.0004\n0.001,0.0015,0.0021,0.0004\n");
  const auto other = granrun(scratch, run_line(scene, moved, "-q --resume --set scene.end_time_s=1"));
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("scene differs"), std::string::npos) << other.err;
}

TEST(GranrunCase, FramesOfAnotherSceneAreNotResumed) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto one = scratch.root / "one", other = scratch.root / "other";
  ASSERT_EQ(granrun(scratch, run_line(scene, one, "-q")).code, 0);
  ASSERT_EQ(granrun(scratch, run_line(scene, other, "-q --set material.friction=0.11")).code, 0);
  for (const auto& entry : fs::directory_iterator(other / "frames"))
    fs::copy_file(entry.path(), one / "frames" / entry.path().filename(),
                  fs::copy_options::overwrite_existing);
  const auto again = granrun(scratch, run_line(scene, one, "-q --resume --set scene.end_time_s=0.05"));
  EXPECT_EQ(again.code, 3) << again.err;
  EXPECT_NE(again.err.find("of another scene"), std::string::npos) << again.err;
}

// Intervals and steps may change in the middle: nothing that happened before is computed again.
TEST(GranrunCase, GoesOnWithOtherIntervals) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto folder = scratch.root / "case";
  ASSERT_EQ(granrun(scratch, run_line(scene, folder, "-q --set scene.end_time_s=0.016")).code, 0);
  const auto rows = content(folder / "history.csv");
  const auto changed =
      granrun(scratch, run_line(scene, folder,
                                "-q --resume --set radiation.every_s=0.001 --set dem.step_s=5e-6 "
                                "--set output.every_s=0.002 --set conduction.every_steps=50"));
  ASSERT_EQ(changed.code, 0) << changed.err;
  const auto history = read_history(folder / "history.csv");
  EXPECT_EQ(content(folder / "history.csv").rfind(rows, 0), 0u);
  ASSERT_EQ(history.at("time_s").size(), 4u + 12u);
  EXPECT_NEAR(history.at("time_s").back(), 0.04, 1e-12);
  for (double defect : history.at("energy_defect")) EXPECT_LE(defect, 1e-10);
  EXPECT_EQ(last_frame(folder).filename(), "f_000006400.hdf");  // 1600 + 0.024 / 5e-6
  EXPECT_NE(content(folder / "run.hdf.series").find("0.04"), std::string::npos);
}

// A launcher that says four and an MPI that knows of one: its ranks would write to one folder.
TEST(GranrunCase, RanksThatDoNotKnowEachOtherAreRefused) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  setenv("PMI_SIZE", "4", 1);
  const auto outcome = granrun(scratch, run_line(scene, scratch.root / "case"));
  unsetenv("PMI_SIZE");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("mpirun"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(scratch.root / "case"));
}

TEST(GranrunCase, RecordSaysWhoComputedItAndHow) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto folder = scratch.root / "case";
  ASSERT_EQ(granrun(scratch, run_line(scene, folder, "-q --threads 2")).code, 0);
  const auto record = content(folder / "run.json");
  for (const char* key : {"\"host\"", "\"threads\": 2", "\"command_line\"", "--threads 2", "\"started\"",
                          "\"wall_seconds\"", "Embree", "HDF5", "\"compiler\""})
    EXPECT_NE(record.find(key), std::string::npos) << key << " in " << record;
  std::ofstream(folder / "run.json", std::ios::trunc) << "{\"scene\": 1}";
  const auto report = granrun(scratch, "report " + folder.string());
  EXPECT_EQ(report.code, 3);
  EXPECT_NE(report.err.find("damaged"), std::string::npos) << report.err;
}

TEST(GranrunCase, WallTimesThatNoClockShowsAreRefused) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug);
  for (const char* time : {"99999999999:00:00", "1:2", "1:60:00", "-1:00:00", "1:00:00x", "4294967297:00:00"})
    EXPECT_EQ(
        granrun(scratch, run_line(scene, scratch.root / "case", std::string("--walltime ") + time)).code, 2)
        << time;
}
