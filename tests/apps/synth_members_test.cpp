// synth --members, run as a user runs it.
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "recipe/sha256.h"
#include "tests/apps/program_runner.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using nlohmann::json;
using testing::expect_refusal;
using testing::Outcome;
using testing::run_program;
using testing::text_of;

const std::string kFamily = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [80, 0, 0, 60]]},
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01, "octaves": 2}],
  "family": {"any_view": true, "fields": [
    {"field": "layers[0].amplitude", "distribution": "uniform", "low": 1, "high": 10},
    {"field": "body.spheres[1].radius", "distribution": "uniform", "low": 40, "high": 90}]}})";

class SynthMembers : public ::testing::Test {
 protected:
  std::string name(const std::string& file) const { return (folder_ / file).string(); }

  Outcome make(const std::string& range, std::vector<std::string> more = {}, const std::string& set = "set") {
    std::vector<std::string> arguments{recipe_,
                                       "--members",
                                       range,
                                       "-o",
                                       name(set + "/body_{member}.ply"),
                                       "--manifest",
                                       name(set + "/set.jsonl"),
                                       "--resolution",
                                       "20"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(kSynth, arguments);
  }
  // The manifest's lines by member, without what depends on the moment.
  std::map<int, json> manifest(const std::string& set = "set") const {
    std::map<int, json> entries;
    std::ifstream file(name(set + "/set.jsonl"));
    for (std::string line; std::getline(file, line);) {
      json entry = json::parse(line, nullptr, false);
      if (entry.is_discarded()) continue;
      entry.erase("seconds");
      entries[entry["member"].get<int>()] = entry;
    }
    return entries;
  }
  void expect_made(const Outcome& outcome, const std::string& counts) {
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_NE(outcome.errors.find(counts), std::string::npos) << outcome.errors;
  }

  testing::WorkFolder folder_;
  const std::string recipe_ = folder_.write("family.json", kFamily);
};

TEST_F(SynthMembers, EachHasFilesAndALine) {
  expect_made(
      make("3:6", {"--preview", name("set/{member}.png"), "--write-recipe", name("set/{member}.json")}),
      "3 made, 0 already there, 0 failed, of 3");
  const auto entries = manifest();
  ASSERT_EQ(entries.size(), 3u);
  for (const auto& [number, entry] : entries) {
    EXPECT_EQ(entry["files"].size(), 3u);
    for (const json& file : entry["files"]) {
      const std::string path = name("set/" + file["name"].get<std::string>());
      EXPECT_EQ(sha256_of_file(path), file["sha256"]);
      EXPECT_EQ(text_of(path).size(), file["bytes"]);
    }
    EXPECT_GE(entry["drawn"]["layers[0].amplitude"], 1.0);
    EXPECT_TRUE(entry["closed"]);
    EXPECT_EQ(entry["view"].size(), 3u);
  }
  EXPECT_NE(entries.at(3)["files"][0]["sha256"], entries.at(4)["files"][0]["sha256"]);
  // The member's own recipe makes the member's mesh.
  const Outcome alone =
      run_program(kSynth, {name("set/0000004.json"), "-o", name("alone.ply"), "--resolution", "20"});
  EXPECT_EQ(alone.status, 0) << alone.errors;
  EXPECT_EQ(sha256_of_file(name("alone.ply")), entries.at(4)["files"][0]["sha256"]);
}

TEST_F(SynthMembers, RangesThreadsAndOrderDoNotMatter) {
  expect_made(make("0:4"), "4 made");
  expect_made(make("2:4", {"--threads", "1"}, "other"), "2 made");
  expect_made(make("0:2", {"--threads", "2"}, "other"), "2 made");
  EXPECT_EQ(manifest(), manifest("other"));
}

TEST_F(SynthMembers, WhatIsThereIsNotMadeAgainAndWhatIsDamagedIs) {
  expect_made(make("0:3"), "3 made, 0 already there");
  const auto before = manifest();
  expect_made(make("0:4"), "1 made, 3 already there");
  std::ofstream(name("set/body_0000001.ply"), std::ios::app) << "x";
  std::filesystem::remove(name("set/body_0000002.ply"));
  expect_made(make("0:3"), "2 made, 1 already there");
  auto after = manifest();
  after.erase(3);
  EXPECT_EQ(after, before);
}

TEST_F(SynthMembers, AnotherSetIsNotWrittenOverThisOne) {
  expect_made(make("0:2"), "2 made");
  const std::string mesh = text_of(name("set/body_0000000.ply")), lines = text_of(name("set/set.jsonl"));
  const Outcome other = make("0:2", {"--min-component", "0.1"});
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.errors.find("has members of another recipe, or made with other options"), std::string::npos)
      << other.errors;
  EXPECT_EQ(text_of(name("set/body_0000000.ply")), mesh);
  EXPECT_EQ(text_of(name("set/set.jsonl")), lines);
}

TEST_F(SynthMembers, MembersMayHaveFoldersOfTheirOwn) {
  const Outcome outcome = run_program(kSynth, {recipe_, "--members", "0:2", "-o", name("{member}/body.ply"),
                                               "--manifest", name("set.jsonl"), "--resolution", "20"});
  expect_made(outcome, "2 made");
  EXPECT_TRUE(std::filesystem::exists(name("0000001/body.ply")));
}

// Small members are made to be predicted, of larger ones the mesh is predicted.
TEST_F(SynthMembers, ASetIsPredictedFromAFewMembers) {
  for (const auto& [range, resolution] :
       {std::pair{std::string("0:50"), std::string("24")}, {"10:13", "140"}}) {
    const std::vector<std::string> options{"--resolution",   resolution,
                                           "--feature-list", name(resolution + "/{member}.csv"),
                                           "--write-recipe", name(resolution + "/{member}.json")};
    std::vector<std::string> predicting{recipe_,     "--members", range,
                                        "--predict", "--summary", name("p.json")};
    predicting.insert(predicting.end(), options.begin(), options.end());
    const auto before = folder_.files();
    predicting.insert(predicting.end(), {"-o", name(resolution + "/{member}.ply")});
    const Outcome outcome = run_program(kSynth, predicting);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    const json predicted = json::parse(text_of(name("p.json")))["predicted"];
    std::filesystem::remove(name("p.json"));
    EXPECT_EQ(folder_.files(), before);  // nothing but the summary was written

    std::vector<std::string> making{recipe_,          "--members",  range,          "--out",
                                    name(resolution), "--manifest", name("m.jsonl")};
    making.insert(making.end(), options.begin(), options.end());
    EXPECT_EQ(run_program(kSynth, making).status, 0);
    double bytes = 0.0, triangles = 0.0;
    std::ifstream manifest(name("m.jsonl"));
    for (std::string line; std::getline(manifest, line);) {
      const json entry = json::parse(line);
      for (const json& file : entry["files"]) bytes += file["bytes"].get<double>();
      triangles += entry["triangles"].get<double>();
    }
    std::filesystem::remove(name("m.jsonl"));
    EXPECT_NEAR(predicted["file_bytes"].get<double>(), bytes, 0.1 * bytes);
    EXPECT_NEAR(predicted["triangles"].get<double>(), triangles, 0.1 * triangles);
    EXPECT_GT(predicted["seconds"], 0.0);
    EXPECT_GT(predicted["peak_bytes"], 1e6);
  }
}

TEST_F(SynthMembers, PredictionNeedsNoNamesAndLooksAtFirstAndLast) {
  const Outcome outcome = run_program(kSynth, {recipe_, "--members", "3:9007199254740992", "--predict",
                                               "--resolution", "20", "--summary", name("p.json")});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const json predicted = json::parse(text_of(name("p.json")))["predicted"];
  EXPECT_EQ(predicted["members"], 9007199254740989);
  EXPECT_EQ(predicted["sampled_members"].size(), 8u);
  EXPECT_EQ(predicted["sampled_members"].front(), 3);
  EXPECT_EQ(predicted["sampled_members"].back(), 9007199254740991);
  EXPECT_GT(predicted["file_bytes"], 0.0);
}

TEST_F(SynthMembers, TheFolderOfTheSummaryIsMadeToo) {
  expect_made(make("0:1", {"--summary", name("sums/a.json")}), "1 made");
  EXPECT_EQ(json::parse(text_of(name("sums/a.json")))["members"]["made"], 1);
}

TEST_F(SynthMembers, AFamilyIsNotLaidOnABase) {
  const std::string layers = folder_.write("layers.json", R"({"format_version": 1, "length_unit": "m",
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01}],
  "family": {"fields": [{"field": "layers[0].amplitude", "low": 1, "high": 10}]}})");
  expect_refusal(folder_, kSynth,
                 {layers, "--base", recipe_, "--members", "0:2", "-o", name("{member}.ply"), "--manifest",
                  name("m.jsonl")},
                 "merge both by --write-recipe, and state it there, where these layers begin at layers[1]");
}

TEST_F(SynthMembers, AFileOfSomebodyElseIsNoManifest) {
  const std::string photo = folder_.write("photo.jpg", std::string(3000, 'x') + "\n");
  const Outcome outcome =
      run_program(kSynth, {recipe_, "--members", "0:2", "-o", name("{member}.ply"), "--manifest", photo});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("is no manifest"), std::string::npos) << outcome.errors;
  EXPECT_EQ(text_of(photo).size(), 3001u);
}

TEST_F(SynthMembers, AManifestThatWasCutShortIsGoneOnWith) {
  expect_made(make("0:3"), "3 made");
  const auto before = manifest();
  const std::string text = text_of(name("set/set.jsonl"));
  std::filesystem::resize_file(name("set/set.jsonl"), text.size() - 40);
  const Outcome outcome = make("0:3");
  expect_made(outcome, "1 made, 2 already there");
  EXPECT_NE(outcome.errors.find("1 line cut short"), std::string::npos) << outcome.errors;
  EXPECT_EQ(manifest(), before);
}

TEST_F(SynthMembers, AMemberThatFailsIsNamedAndTheOthersGoOn) {
  // A folder stands where a member's mesh should be.
  std::filesystem::create_directories(name("set/body_0000001.ply"));
  const Outcome outcome = make("0:3");
  EXPECT_EQ(outcome.status, 1) << outcome.errors;
  EXPECT_NE(outcome.errors.find("synth: member 1: "), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find("2 made, 0 already there, 1 failed, of 3"), std::string::npos)
      << outcome.errors;
  EXPECT_EQ(manifest().size(), 2u);
}

TEST_F(SynthMembers, WrongRequestsAreRefusedBeforeAnyWork) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& culprit) {
    arguments.insert(arguments.begin(), recipe_);
    expect_refusal(folder_, kSynth, arguments, culprit);
  };
  const std::string mesh = name("{member}.ply"), manifest = name("m.jsonl");
  refused({"--members", "5:5", "-o", mesh, "--manifest", manifest}, "--members: 5:5 holds no member");
  refused({"--members", "7:5", "-o", mesh, "--manifest", manifest}, "--members: 7:5 holds no member");
  refused({"--members", "-1:5", "-o", mesh, "--manifest", manifest}, "--members: must be A:B");
  refused({"--members", "0:9007199254740993", "-o", mesh, "--manifest", manifest}, "--members: must be A:B");
  refused({"--members", "12", "-o", mesh, "--manifest", manifest}, "--members: must be A:B");
  refused({"--members", "0:2", "-o", name("body.ply"), "--manifest", manifest},
          "--output: every member writes");
  refused({"--members", "0:2", "-o", mesh, "--manifest", manifest, "--preview", name("{member}.png"),
           "--preview-maps", name("a.npz")},
          "--preview-maps: every member writes");
  refused({"--members", "0:2", "-o", mesh}, "--manifest: is required");
  refused({"--members", "0:2", "-o", mesh, "--manifest", ""}, "--manifest: is given without a name");
  refused({"--members", "0:2", "--out", "", "--manifest", manifest}, "--out: is given without a name");
  refused({"--members", "0:2", "--write-recipe", name("{member}.astro"), "--preview", name("{member}.png"),
           "--manifest", manifest},
          "--write-recipe without -o keeps recipes alone");
  refused({"--members", "0:2", "--predict", "-o", name("{member}.obj"), "--labels"}, ".ply");
  refused({"--members", "0:2", "--predict", "-o", name("{member}.foo")}, "{member}.foo");
  // Options that contradict each other are no failure of each member.
  refused({"--members", "0:2", "-o", mesh, "--manifest", manifest, "--labels", "--gravity", "2000", "8"},
          "--gravity: is of the whole mesh");
  refused({"--members", "0:2", "-o", mesh, "--manifest", manifest, "--gravity", "-1", "8"},
          "--gravity: the density must be above 0");
  refused({"--members", "0:2", "--predict", "--labels", "--gravity", "2000", "8"},
          "--gravity: is of the whole mesh");
  EXPECT_EQ(
      run_program(kSynth, {recipe_, "--members", "0:1", "--out", name("one"), "--manifest", manifest}).status,
      0);
  EXPECT_EQ(run_program(kSynth,
                        {recipe_, "--members", "0:2", "-o", name("one/{member}.ply"), "--manifest", manifest})
                .status,
            0);  // both ways go on with one set
  const std::string pipe = name("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  refused({"--members", "0:2", "-o", mesh, "--manifest", pipe},
          "pipe is a folder, a device or a pipe; give the name of a file");
  refused({"--members", "0:2", "-o", mesh, "--manifest", name("0000012.ply")}, "--manifest: ");
}

}  // namespace
}  // namespace astrolith
