#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "io/text_file.h"
#include "programs/command.h"
#include "support/sequences.h"
#include "support/temporary_directory.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::runCommand;

/// Runs in a directory with a sound labelled sequence "seq" of eight scans.
class Programs : public testing::Test {
 protected:
  void SetUp() override { test::writeSoundSequence(path("seq"), 8); }

  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }

  Outcome run(const char* program, const std::string& arguments) {
    return runCommand("cd " + directory_.path().string() + " && " + program + " " + arguments);
  }
  Outcome expect(int code, const std::string& part, const char* program, const std::string& arguments) {
    Outcome outcome = run(program, arguments);
    EXPECT_EQ(outcome.code, code) << outcome.text;
    EXPECT_NE(outcome.text.find(part), std::string::npos) << "'" << part << "' is not in\n" << outcome.text;
    return outcome;
  }

  test::TemporaryDirectory directory_;
};

TEST_F(Programs, SequenceWritesLabelsAndFigures) {
  const Outcome outcome = expect(0, "8 scans, 80 echoes", DONEX_SEQUENCE, "seq --out pred");
  for (const char* part : {"time a scan: median", "p99", "echoes a second", "peak memory", "IoU", "donex_3d, 0.2 m"}) {
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << " is not in\n" << outcome.text;
  }
  EXPECT_EQ(outcome.text.find('\r'), std::string::npos) << "a progress bar although this is no terminal";
  for (std::size_t i = 0; i < 8; ++i) {
    const auto labels = readLabels(directory_.path() / "pred" / (scanName(i) + ".label"));
    ASSERT_EQ(labels.size(), 10U);
    for (const std::uint32_t label : labels) EXPECT_TRUE(label == kLabelMoving || label == kLabelStatic);
  }
}

TEST_F(Programs, SequenceTakesOptions) {
  expect(0, "3 scans, 30 echoes", DONEX_SEQUENCE, "--frames 3 --out pred seq");
  EXPECT_FALSE(fs::exists(path("pred/000003.label")));
  expect(0, "8 scans, 80 echoes", DONEX_SEQUENCE, "--parts 4 --out cut seq");
  EXPECT_EQ(readLabels(path("cut/000007.label")).size(), 10U);
  expect(0, "donex_2d, 0.4 m", DONEX_SEQUENCE, "--method donex_2d --voxel-size 0.4 seq");
  test::writeText(path("config.yaml"), "voxel_size: 0.5\nmethod: donex_2d\n");
  expect(0, "donex_2d, 0.5 m", DONEX_SEQUENCE, "--config config.yaml seq");
  test::writeText(path("over.yaml"), "voxel_size: 0.6\n");
  expect(0, "donex_2d, 0.6 m", DONEX_SEQUENCE, "--config config.yaml --config over.yaml seq");
  expect(0, "donex_2d, 0.5 m", DONEX_SEQUENCE, "--config over.yaml --config config.yaml seq");
  expect(0, "donex_2d, 0.3 m", DONEX_SEQUENCE, "--config config.yaml --set voxel_size=0.3 --set queue_size=3 seq");
}

TEST_F(Programs, SequenceWritesThePosesThatItFinds) {
  expect(0, "8 scans, 80 echoes", DONEX_SEQUENCE, "seq --out given");
  EXPECT_FALSE(fs::exists(path("given/poses.txt"))) << "they are the sequence's own";
  expect(0, "odometry from the scans", DONEX_SEQUENCE, "seq --odometry lidar --out found");
  Faults faults;
  const auto lines = readLines(path("found/poses.txt"), faults);
  ASSERT_TRUE(lines);
  ASSERT_EQ(lines->size(), 8U);
  for (const std::string& line : *lines) EXPECT_TRUE(parsePose(line, "found/poses.txt", faults)) << line;
}

TEST_F(Programs, SequenceWithoutLabelsIsNotScored) {
  fs::remove_all(path("seq/labels"));
  fs::remove(path("seq/times.txt"));
  const Outcome outcome = expect(0, "not scored: the sequence has no labels", DONEX_SEQUENCE, "seq");
  EXPECT_NE(outcome.text.find("donex_sequence: seq/times.txt: is missing"), std::string::npos) << outcome.text;
}

TEST_F(Programs, SequenceRefusesWrongArguments) {
  expect(2, "SEQ_DIR is required", DONEX_SEQUENCE, "");
  expect(2, "", DONEX_SEQUENCE, "seq --nonsense");
  expect(2, "", DONEX_SEQUENCE, "seq --frames 0");
  expect(2, "--parts", DONEX_SEQUENCE, "seq --parts 0");
  expect(2, "'method=donex': method is donex, must be one of", DONEX_SEQUENCE, "seq --method donex");
  expect(2, "'voxel_size=9': voxel_size is 9", DONEX_SEQUENCE, "seq --voxel-size 9");
  expect(2, "there is no parameter nonsense", DONEX_SEQUENCE, "seq --set nonsense=1");
  expect(2, "holds the ground truth", DONEX_SEQUENCE, "seq --out seq/labels");
  EXPECT_EQ(readLabels(path("seq/labels/000000.label")), std::vector<std::uint32_t>(10, kLabelStatic));
}

TEST_F(Programs, SequenceNamesBadData) {
  expect(1, "donex_sequence: none: is not a directory", DONEX_SEQUENCE, "none");
  expect(1, "none.yaml: cannot be read", DONEX_SEQUENCE, "seq --config none.yaml");
  test::writeText(path("bad.yaml"), "voxel_size: 9\nnonsense: 1\n");
  expect(1, "bad.yaml:2: there is no parameter nonsense", DONEX_SEQUENCE, "seq --config bad.yaml");
  test::writeText(path("a_file"), "");
  expect(1, "a_file/pred: cannot be created", DONEX_SEQUENCE, "seq --out a_file/pred");
  fs::resize_file(path("seq/velodyne/000002.bin"), 17);
  expect(1, "seq/velodyne/000002.bin: 17 bytes, no multiple of 16", DONEX_SEQUENCE, "seq");
}

TEST_F(Programs, HelpIsNoError) {
  expect(0, "SEQ_DIR", DONEX_SEQUENCE, "--help");
  expect(0, "PRED_DIR", DONEX_EVALUATE, "--help");
}

TEST_F(Programs, EvaluateScoresSideBySide) {
  fs::copy(path("seq/labels"), path("truth"));
  run(DONEX_SEQUENCE, "seq --out pred");
  const Outcome outcome = expect(0, "\ntruth  ", DONEX_EVALUATE, "seq truth pred");
  EXPECT_NE(outcome.text.find("\npred  "), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("\nstatic  "), std::string::npos) << outcome.text;
}

TEST_F(Programs, EvaluateNeverGuesses) {
  fs::copy(path("seq/labels"), path("pred"));
  fs::resize_file(path("pred/000005.label"), 36);
  fs::remove(path("pred/000006.label"));
  const Outcome outcome =
      expect(1, "pred/000005.label: 9 labels for 10 echoes, not scored", DONEX_EVALUATE, "seq pred");
  EXPECT_NE(outcome.text.find("pred/000006.label: No such file or directory, not scored"), std::string::npos)
      << outcome.text;
  EXPECT_NE(outcome.text.find("prediction"), std::string::npos) << "the scan that is whole is scored all the same";
  expect(0, "prediction", DONEX_EVALUATE, "seq pred --frames 5");  // the faulty ones are not asked for
}

TEST_F(Programs, EvaluateRefusesWhatItCannotScore) {
  expect(2, "PRED_DIR is required", DONEX_EVALUATE, "seq");
  expect(1, "none: is not a directory", DONEX_EVALUATE, "seq none");
  fs::remove_all(path("seq/labels"));
  expect(1, "seq/labels: holds no labels to score by", DONEX_EVALUATE, "seq seq");
}

TEST_F(Programs, EvaluateWritesReports) {
  run(DONEX_SEQUENCE, "seq --out pred");
  expect(0, "prediction", DONEX_EVALUATE, "seq pred --csv out.csv --json out.json --html out.html");
  for (const char* file : {"out.csv", "out.json", "out.html", "pred/run.json"}) {
    EXPECT_TRUE(fs::exists(path(file))) << file;
  }
  expect(1, "none/out.csv: cannot be written", DONEX_EVALUATE, "seq pred --csv none/out.csv");
}

TEST_F(Programs, CompareRunsEveryMethodAndReports) {
  const Outcome outcome = expect(0, "out/report.html", DONEX_COMPARE, "seq --out out");
  std::vector<std::string> names{"donex_3d", "donex_2d", "paper_3d", "paper_3d_zbuffer", "paper_2d"};
  for (const Method method : allMethods()) {
    if (infoOf(method).kind == MethodKind::kComparison) names.push_back(nameOf(method));
  }
  for (const std::string& name : names) {
    EXPECT_NE(outcome.text.find(name), std::string::npos) << name;
    EXPECT_TRUE(fs::exists(path("out/predictions/seq/" + name + "/000007.label"))) << name;
  }
  EXPECT_TRUE(fs::exists(path("out/table_1/donex_2d_0.15/run.json")));
}

TEST_F(Programs, MethodsAreListed) {
  for (const Method method : allMethods()) {
    expect(0, std::string(nameOf(method)) + '\t', DONEX_SEQUENCE, "--list-methods");
  }
  expect(0, "peopleremover\twhole drive\t", DONEX_MAP, "--list-methods");
}

TEST_F(Programs, CompareRefusesWhatItCannotRun) {
  expect(2, "--out is required", DONEX_COMPARE, "seq");
  expect(2, "there is no method donex, only donex_3d, ", DONEX_COMPARE, "seq --out out --methods donex");
  expect(1, "none: is not a directory", DONEX_COMPARE, "seq none --out out");
  fs::remove(path("seq/times.txt"));
  const std::string order = "--out few --frames 3 --skip-table-1 --methods paper_2d,paper_3d seq";
  const Outcome few = expect(0, "few/report.html", DONEX_COMPARE, order);
  EXPECT_NE(few.text.find("times.txt: is missing"), std::string::npos) << few.text;
  fs::remove_all(path("seq/labels"));
  expect(1, "seq/labels: holds no labels to score by", DONEX_COMPARE, "seq --out out");
}

TEST_F(Programs, DisturbAddsEchoesWithTruth) {
  expect(0, "", DONEX_DISTURB, "seq out --own-body");
  const SequenceReader before(path("seq")), after(path("out"));
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(after.stamp(5), before.stamp(5));
  ASSERT_EQ(after.echoes(5), before.echoes(5) + 400);
  const auto labels = after.labels(5), labels_before = before.labels(5);
  EXPECT_TRUE(std::equal(labels_before.begin(), labels_before.end(), labels.begin()));
  expect(2, "nothing to add", DONEX_DISTURB, "seq other");
  expect(2, "rain is 2, must be between 0 and 1", DONEX_DISTURB, "seq other --rain 2");
  expect(2, "is there already; --overwrite", DONEX_DISTURB, "seq out --rain 0.1");
  expect(2, "is an input, which would be overwritten", DONEX_DISTURB, "seq seq --rain 0.1 --overwrite");
}

TEST_F(Programs, WholeDriveMethodsRunOnSequences) {
  expect(0, "8 scans, 80 echoes", DONEX_SEQUENCE, "seq --method peopleremover --out pred");
  EXPECT_TRUE(fs::exists(path("pred/000007.label")));
}

TEST_F(Programs, MapIsBuiltAndScored) {
  const Outcome outcome = expect(0, "8 scans, ", DONEX_MAP, "seq map.pcd --compare --method donex_2d");
  EXPECT_NE(outcome.text.find("by voxel of 0.2 m (ERASOR)"), std::string::npos) << outcome.text;
  EXPECT_GT(fs::file_size(path("map.pcd")), 300U);
  expect(1, "none: is not a directory", DONEX_MAP, "none new.pcd");
  expect(1, "/none: is not a directory", DONEX_MAP, "seq none/map.pcd");
  fs::remove_all(path("seq/labels"));
  expect(1, "seq/labels: holds no labels to score by", DONEX_MAP, "seq map.pcd --compare --overwrite");
}

/// What is there keeps its content, whatever is said but --overwrite; an input keeps it always.
class Overwriting : public Programs {
 protected:
  void refuses(const std::string& file, const std::string& sentence, const char* program,
               const std::string& arguments) {
    if (!fs::exists(path(file))) test::writeText(path(file), "somebody's");
    const std::string before = test::readText(path(file));
    const Outcome outcome = run(program, arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << '\n' << outcome.text;
    EXPECT_NE(outcome.text.find(sentence), std::string::npos) << arguments << '\n' << outcome.text;
    EXPECT_EQ(test::readText(path(file)), before) << arguments;
  }
};

TEST_F(Overwriting, IsRefusedByEveryProgram) {
  const std::string there = ": is there already; --overwrite replaces";
  fs::create_directories(path("pred"));
  refuses("pred/000003.label", "000003.label" + there, DONEX_SEQUENCE, "seq --out pred");
  refuses("map.pcd", "map.pcd" + there, DONEX_MAP, "seq map.pcd");
  expect(0, "8 scans", DONEX_SEQUENCE, "seq --out pred --overwrite");
  for (const char* kind : {"csv", "json", "html"}) {
    const std::string file = std::string("report.") + kind;
    refuses(file, file + there, DONEX_EVALUATE, "seq pred --" + std::string(kind) + " " + file);
    fs::remove(path(file));
  }
  fs::create_directories(path("compared"));
  refuses("compared/report.csv", "report.csv" + there, DONEX_COMPARE, "seq --out compared");
#ifdef DONEX_BAG
  refuses("in.bag", "in.bag" + there, DONEX_SEQUENCE_TO_BAG, "seq in.bag");
  refuses("in.bag", "in.bag" + there, DONEX_SIMULATE, "empty_room in.bag --duration 0.2");
  expect(0, "8 clouds", DONEX_SEQUENCE_TO_BAG, "seq in.bag --overwrite");
#endif
  expect(0, "8 scans", DONEX_MAP, "seq map.pcd --overwrite");
}

TEST_F(Overwriting, OfAnInputIsRefusedByWhateverPath) {
  const std::string input = ": is an input, which would be overwritten";
  const std::string cloud = "seq/velodyne/000003.bin";
  fs::create_symlink("seq/velodyne/000003.bin", path("soft.pcd"));
  fs::create_hard_link(path(cloud), path("hard.pcd"));
  for (const std::string& name : {cloud, std::string("soft.pcd"), std::string("hard.pcd")}) {
    refuses(cloud, name + input, DONEX_MAP, "seq " + name + " --overwrite");
  }
  fs::create_directories(path("pred"));
  fs::create_hard_link(path("seq/labels/000003.label"), path("pred/000003.label"));
  refuses("seq/labels/000003.label", "000003.label" + input, DONEX_SEQUENCE, "seq --out pred --overwrite");
  fs::create_directory_symlink(path("seq"), path("other_seq"));
  refuses("seq/labels/000003.label", "holds the ground truth", DONEX_SEQUENCE,
          "seq --out other_seq/labels --overwrite");
  fs::create_symlink("nowhere", path("dangling.pcd"));
  expect(2, "dangling.pcd: is there already", DONEX_MAP, "seq dangling.pcd");
  EXPECT_TRUE(fs::is_symlink(path("dangling.pcd")));
}

#ifdef DONEX_BAG

TEST_F(Programs, MapIsBuiltFromABag) {
  run(DONEX_SEQUENCE_TO_BAG, "seq in.bag");
  expect(0, "8 scans, ", DONEX_MAP, "in.bag map.pcd --method peopleremover");
  expect(1, "in.bag: no cloud on /points has a field label", DONEX_MAP, "in.bag other.pcd --compare");
  EXPECT_FALSE(fs::exists(path("other.pcd")));
  expect(2, "--points and --odom are for bags", DONEX_MAP, "seq new.pcd --points /points");
  expect(2, "--frames is for sequences", DONEX_MAP, "in.bag new.pcd --frames 3");
}

/// "(N static, M moving)" of a map's score.
std::string scoredEchoes(const Outcome& outcome) {
  const std::size_t line = outcome.text.find("by echo (DynamicMap_Benchmark)");
  const std::size_t begin = outcome.text.find("   (", line);
  return begin == std::string::npos ? "" : outcome.text.substr(begin, outcome.text.find(')', begin) - begin);
}

TEST_F(Programs, MapOfABagIsScoredByTheTruthOfItsClouds) {
  const std::string scene = " --duration 1 --beams 16 --odometry-drift 0";
  run(DONEX_SIMULATE, "intersection drive" + scene);
  run(DONEX_SIMULATE, "intersection drive.bag" + scene);
  const Outcome sequence = expect(0, "AA ", DONEX_MAP, "drive a.pcd --compare");
  const Outcome bag = expect(0, "AA ", DONEX_MAP, "drive.bag b.pcd --compare");
  EXPECT_NE(scoredEchoes(sequence), "") << sequence.text;
  EXPECT_EQ(scoredEchoes(bag), scoredEchoes(sequence)) << bag.text;
}

TEST_F(Programs, BagWritesASummary) {
  run(DONEX_SEQUENCE_TO_BAG, "seq in.bag");
  expect(0, "8 of 8", DONEX_BAG, "in.bag out.bag --summary out.json");
  std::ifstream stream(path("out.json"));
  std::string text;
  std::getline(stream, text);
  EXPECT_NE(text.find("\"labeled\": 8, \"dropped\": 0"), std::string::npos) << text;
  EXPECT_NE(text.find("\"prediction\": {"), std::string::npos) << text;
}

TEST_F(Programs, BagIsLabelled) {
  expect(0, "8 clouds on /points, 8 odometry messages", DONEX_SEQUENCE_TO_BAG, "seq in.bag");
  expect(0, "8 of 8 clouds labelled, 0 dropped", DONEX_BAG, "in.bag out.bag");
  EXPECT_TRUE(fs::exists(path("out.bag")));
  expect(1, "choose another name with --labeled", DONEX_BAG, "out.bag again.bag");
  expect(0, "8 of 8", DONEX_BAG, "out.bag again.bag --points /points --labeled /labeled --set method=donex_2d");
}

TEST_F(Programs, BagRefusesWrongArguments) {
  run(DONEX_SEQUENCE_TO_BAG, "seq in.bag");
  const auto size = fs::file_size(path("in.bag"));
  expect(2, "required", DONEX_BAG, "in.bag");
  expect(2, "./in.bag: is an input", DONEX_BAG, "in.bag ./in.bag --overwrite");
  expect(2, "there is no parameter x", DONEX_BAG, "in.bag out.bag --set x=1");
  expect(2, "", DONEX_SEQUENCE_TO_BAG, "seq other.bag --odom-rate 0");
  expect(2, "", DONEX_SEQUENCE_TO_BAG, "seq other.bag --compression zip");
  EXPECT_EQ(fs::file_size(path("in.bag")), size);
}

TEST_F(Programs, BagNamesBadData) {
  expect(1, "none.bag: does not exist", DONEX_BAG, "none.bag out.bag");
  test::writeText(path("text.bag"), "no bag");
  expect(1, "text.bag: is not a bag or is cut off", DONEX_BAG, "text.bag out.bag");
  run(DONEX_SEQUENCE_TO_BAG, "seq in.bag");
  expect(1, "in.bag: has no topic /none (--points); its topics are:", DONEX_BAG, "in.bag out.bag --points /none");
  fs::remove(path("out.bag"));
  fs::resize_file(path("in.bag"), fs::file_size(path("in.bag")) - 100);
  expect(1, "in.bag: ", DONEX_BAG, "in.bag out.bag");
  EXPECT_FALSE(fs::exists(path("out.bag")));
  expect(1, "none: is not a directory", DONEX_SEQUENCE_TO_BAG, "none out.bag");
}

#endif

}  // namespace
}  // namespace donex
