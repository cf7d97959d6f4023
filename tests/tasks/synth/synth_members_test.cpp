// synth --members.
#include <sys/stat.h>

#include <map>

#include "numerics/files/sha256.h"
#include "tasks/job/device_option.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using Json = nlohmann::json;
using testing::has;
using testing::Outcome;

const std::string kFamily = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [80, 0, 0, 60]]},
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01, "octaves": 2}],
  "family": {"any_view": true, "fields": [
    {"field": "layers[0].amplitude", "distribution": "uniform", "low": 1, "high": 10},
    {"field": "body.spheres[1].radius", "distribution": "uniform", "low": 40, "high": 90}]}})";

class SynthMembers : public SynthTest {
 protected:
  SynthMembers() { write("r.json", kFamily); }

  Outcome make(const std::string& range, const std::string& more = "", const std::string& set = "set") {
    return run("r.json --members " + range + " -o " + set + "/body_{member}.ply --manifest " + set +
               "/set.jsonl --resolution 20 " + more);
  }
  // The manifest's lines by member, without what depends on the moment.
  std::map<int, Json> manifest(const std::string& set = "set") const {
    std::map<int, Json> entries;
    std::istringstream file(text(set + "/set.jsonl"));
    for (std::string line; std::getline(file, line);) {
      Json entry = Json::parse(line, nullptr, false);
      if (entry.is_discarded()) continue;
      entry.erase("seconds");
      entries[entry["member"].get<int>()] = entry;
    }
    return entries;
  }
  void expect_made(const Outcome& outcome, const std::string& counts) {
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_TRUE(has(outcome.errors, counts));
  }
};

TEST_F(SynthMembers, OptionsOfTheCameraWinOverTheFamily) {
  const std::string picture = "--preview set/{member}.png --picture-size 32x32 ";
  expect_made(make("0:1", picture), "1 made");
  EXPECT_TRUE(manifest().at(0).contains("view"));
  const std::string others = "--preview other/{member}.png --picture-size 32x32 --view 0 0 1";
  expect_made(make("0:1", others, "other"), "1 made");
  EXPECT_FALSE(manifest("other").at(0).contains("view"));
}

// Levels and maps are files of the member like its mesh: the manifest tells when one of them is lost.
TEST_F(SynthMembers, HaveLevelsAndMaps) {
  const std::string pack =
      "r.json --members 0:2 -o set/{member}.obj --manifest set/set.jsonl --resolution 32 --lod 2 --uv charts "
      "--bake 128";
  expect_made(run(pack), "2 made");
  const Json files = manifest().at(1)["files"];
  EXPECT_EQ(files.size(), 14u);  // two meshes with a material and five maps each
  EXPECT_EQ(files.back()["name"], "0000001_lod1_label.png");
  expect_made(run(pack), "0 made, 2 already there");
  std::filesystem::remove(folder_ / "set/0000001_lod1_normal.png");
  expect_made(run(pack), "1 made, 1 already there");
  refuse("r.json --members 0:2 -o set/{member}.glb --uv charts --bake 128 --sheet s.png --manifest m.jsonl",
         "--sheet excludes --manifest");
  refuse("r.json --members 0:61 -o set/{member}.glb --uv charts --bake 128 --sheet s.png",
         "--sheet: shows 60 members at most");
}

TEST_F(SynthMembers, EachHasFilesAndALine) {
  expect_made(make("3:5", "--preview set/{member}.png --write-recipe set/{member}.json"),
              "2 made, 0 already there, 0 failed, of 2");
  const auto entries = manifest();
  ASSERT_EQ(entries.size(), 2u);
  for (const auto& [number, entry] : entries) {
    EXPECT_EQ(entry["files"].size(), 3u);
    for (const Json& file : entry["files"]) {
      const std::string path = "set/" + file["name"].get<std::string>();
      EXPECT_EQ(file_sha256(folder_ / path), file["sha256"]);
      EXPECT_EQ(text(path).size(), file["bytes"]);
    }
    EXPECT_GE(entry["drawn"]["layers[0].amplitude"], 1.0);
    EXPECT_TRUE(entry["closed"]);
    EXPECT_EQ(entry["view"].size(), 3u);
  }
  EXPECT_NE(entries.at(3)["files"][0]["sha256"], entries.at(4)["files"][0]["sha256"]);
  // The member's own recipe makes the member's mesh.
  succeed("set/0000004.json -o alone.ply --resolution 20");
  EXPECT_EQ(file_sha256(folder_ / "alone.ply"), entries.at(4)["files"][0]["sha256"]);
}

// A manifest in a folder that is a symbolic link names files by the way that the system goes.
TEST_F(SynthMembers, AreFoundThroughALink) {
  std::filesystem::create_directories(folder_ / "deep/deeper");
  std::filesystem::create_directory_symlink("deep/deeper", folder_ / "link");
  const std::string line =
      "r.json --members 0:2 -o bodies/{member}.ply --manifest link/m.jsonl --resolution 16";
  expect_made(run(line), "2 made");
  const std::string name =
      Json::parse(text("link/m.jsonl").substr(0, text("link/m.jsonl").find('\n')))["files"][0]["name"];
  EXPECT_TRUE(name.starts_with("../../bodies/")) << name;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "link" / name));
  expect_made(run(line), "0 made, 2 already there");
}

// Threads make members beside each other. The folder of one is a file, so that it fails among the others.
TEST_F(SynthMembers, EachIsMadeOnceBesideOthersOfWhichOneFails) {
  write("0000005", "no folder");
  const Outcome outcome =
      run("r.json --members 0:12 -o {member}/body.ply --manifest set/set.jsonl --resolution 20");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(has(outcome.errors, "11 made, 0 already there, 1 failed, of 12")) << outcome.errors;
  EXPECT_TRUE(has(outcome.errors, "member 5: ")) << outcome.errors;
  const auto entries = manifest();
  EXPECT_EQ(entries.size(), 11u);
  EXPECT_FALSE(entries.contains(5));
}

// Members of a family differ as it says, and their variations in silhouette too.
TEST_F(SynthMembers, OfAFamilyAreVaried) {
  expect_made(make("1:2", "--vary 0.3"), "1 made");
  const Json entry = manifest().at(1);
  EXPECT_GE(entry["drawn"]["body.spheres[1].radius"], 40.0);
  EXPECT_GE(entry["similarity"], 0.7);
  EXPECT_GT(entry["variation"]["mean_distance"], 0.0);
  expect_made(make("1:2", "", "plain"), "1 made");
  EXPECT_EQ(manifest("plain").at(1)["drawn"], entry["drawn"]);
}

TEST_F(SynthMembers, SayHowMuchTheyDiffer) {
  const auto differences = [&](const std::string& recipe) {
    return figures(recipe + " --members 0:3 --out " + recipe +
                   "_set --resolution 24")["members"]["differences"];
  };
  const auto family = differences("r.json");
  EXPECT_EQ(family["members"], 3);
  EXPECT_GT(family["silhouettes"]["most"], 0.01);
  EXPECT_LE(family["silhouettes"]["least"], family["silhouettes"]["mean"]);
  EXPECT_GT(family["mean_distance"]["mean"], 0.001);
  write("same.json", R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [80, 0, 0, 60]]}})");
  const auto same = differences("same.json");
  EXPECT_EQ(same["silhouettes"]["most"], 0.0);
  EXPECT_LT(same["mean_distance"]["most"], 1e-6);
}

TEST_F(SynthMembers, RangesThreadsAndOrderDoNotMatter) {
  expect_made(make("0:4"), "4 made");
  expect_made(make("2:4", "--threads 1", "other"), "2 made");
  expect_made(make("0:2", "--threads 2", "other"), "2 made");
  EXPECT_EQ(manifest(), manifest("other"));
}

TEST_F(SynthMembers, WhatIsThereIsNotMadeAgainAndWhatIsDamagedIs) {
  expect_made(make("0:3"), "3 made, 0 already there");
  const auto before = manifest();
  expect_made(make("0:4"), "1 made, 3 already there");
  std::ofstream(folder_ / "set/body_0000001.ply", std::ios::app) << "x";
  std::filesystem::remove(folder_ / "set/body_0000002.ply");
  expect_made(make("0:3"), "2 made, 1 already there");
  auto after = manifest();
  after.erase(3);
  EXPECT_EQ(after, before);
}

TEST_F(SynthMembers, AnotherSetIsNotWrittenOverThisOne) {
  expect_made(make("0:2"), "2 made");
  const std::string mesh = text("set/body_0000000.ply"), lines = text("set/set.jsonl");
  const Outcome other = make("0:2", "--min-component 0.1");
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(has(other.errors, "has members of another recipe, or made with other options"));
  EXPECT_EQ(text("set/body_0000000.ply"), mesh);
  EXPECT_EQ(text("set/set.jsonl"), lines);
}

// The bodies of a set are like one target: another mesh under the target's name makes another set.
TEST_F(SynthMembers, AnotherTargetIsAnotherSet) {
  write("r.json", kTwoSpheres);
  succeed("r.json -o target.ply --resolution 16");
  expect_made(make("0:1", "--vary 0.3 --target target.ply"), "1 made");
  std::filesystem::copy(folder_ / "target.ply", folder_ / "copy.ply");
  expect_made(make("0:1", "--vary 0.3 --target copy.ply"), "0 made, 1 already there");
  succeed("r.json -o target.ply --resolution 12");
  const Outcome other = make("0:1", "--vary 0.3 --target target.ply");
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(has(other.errors, "has members of another recipe, or made with other options"));
}

// Members have copies of the options, and work beside each other.
TEST_F(SynthMembers, AGpuThatFailsIsToldOnceAndNotTriedAgain) {
  const auto declare = [](Job& job) -> JobWork {
    const auto device = std::make_shared<DeviceOption>();
    device->add_to(job.options);
    return [&job, device] {
      std::vector<DeviceOption> member_devices(3, *device);
      for (int failing = 0; failing < 2; ++failing) {
        JobPart member(job);
        try {
          throw DeviceError("GPU: failure " + std::to_string(failing));
        } catch (const DeviceError& error) {
          EXPECT_FALSE(member_devices[static_cast<std::size_t>(failing)].after_failure(member, error));
        }
      }
      JobPart next(job);
      EXPECT_FALSE(member_devices[2].has_gpu());
      EXPECT_EQ(member_devices[2].choose(next).words, "computed on the CPU: the GPU failed before");
    };
  };
  const Outcome outcome = testing::run_job("synth", declare, {"--device", "auto"}, folder_.path());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors, "GPU: failure 0; the CPU does the work from its beginning\n");
}

TEST_F(SynthMembers, MembersOfAnotherVersionAreNotContinued) {
  expect_made(make("0:2"), "2 made");
  const std::string lines = text("set/set.jsonl");
  const std::string version = manifest().at(0)["version"];
  write("set/set.jsonl", replaced(lines, version, "synth 0.0.1 (abcdef0)"));
  const Outcome other = make("0:3");
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(has(other.errors, "has members that synth 0.0.1 (abcdef0) made, and this is " + version));
  EXPECT_FALSE(exists("set/body_0000002.ply"));
}

TEST_F(SynthMembers, MembersMayHaveFoldersOfTheirOwn) {
  expect_made(run("r.json --members 0:2 -o {member}/body.ply --manifest m.jsonl --resolution 20 --summary "
                  "sums/a.json"),
              "2 made");
  EXPECT_TRUE(exists("0000001/body.ply"));
  EXPECT_EQ(json("sums/a.json")["members"]["made"], 2);
}

// Small members are made to be predicted, of larger ones the mesh is predicted.
TEST_F(SynthMembers, ASetIsPredictedFromAFewMembers) {
  for (const auto& [range, set] : {std::pair{std::string("0:50"), std::string("24")}, {"10:13", "140"}}) {
    const std::string options = "r.json --members " + range + " --resolution " + set + " --feature-list " +
                                set + "/{member}.csv --write-recipe " + set + "/{member}.json ";
    const auto before = folder_.files();
    const auto predicted = figures(options + "--predict -o " + set + "/{member}.ply")["predicted"];
    std::filesystem::remove(folder_ / "s.json");
    EXPECT_EQ(folder_.files(), before);  // nothing but the summary was written

    succeed(options + "--out " + set + " --manifest m.jsonl");
    double bytes = 0.0, triangles = 0.0;
    std::istringstream manifest(text("m.jsonl"));
    for (std::string line; std::getline(manifest, line);) {
      const Json entry = Json::parse(line);
      for (const Json& file : entry["files"]) bytes += file["bytes"].get<double>();
      triangles += entry["triangles"].get<double>();
    }
    std::filesystem::remove(folder_ / "m.jsonl");
    EXPECT_NEAR(predicted["file_bytes"], bytes, 0.1 * bytes);
    EXPECT_NEAR(predicted["triangles"], triangles, 0.1 * triangles);
    EXPECT_GT(predicted["seconds"], 0.0);
    EXPECT_GT(predicted["peak_bytes"], 1e6);
  }
}

TEST_F(SynthMembers, PredictionNeedsNoNamesAndLooksAtFirstAndLast) {
  const auto predicted =
      figures("r.json --members 3:9007199254740992 --predict --resolution 20")["predicted"];
  EXPECT_EQ(predicted["members"], 9007199254740989);
  EXPECT_EQ(predicted["sampled_members"].size(), 8u);
  EXPECT_EQ(predicted["sampled_members"].front(), 3);
  EXPECT_EQ(predicted["sampled_members"].back(), 9007199254740991);
  EXPECT_GT(predicted["file_bytes"], 0.0);
}

TEST_F(SynthMembers, AFamilyIsNotLaidOnABase) {
  write("layers.json", R"({"format_version": 1, "length_unit": "m",
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01}],
  "family": {"fields": [{"field": "layers[0].amplitude", "low": 1, "high": 10}]}})");
  refuse("layers.json --base r.json --members 0:2 -o {member}.ply --manifest m.jsonl",
         "merge both by --write-recipe, and state it there, where these layers begin at layers[1]");
}

TEST_F(SynthMembers, AFileOfSomebodyElseIsNoManifest) {
  write("photo.jpg", std::string(3000, 'x') + "\n");
  refuse("r.json --members 0:2 -o {member}.ply --manifest photo.jpg", "is no manifest");
  EXPECT_EQ(text("photo.jpg").size(), 3001u);
}

TEST_F(SynthMembers, AManifestThatWasCutShortIsGoneOnWith) {
  expect_made(make("0:3"), "3 made");
  const auto before = manifest();
  std::filesystem::resize_file(folder_ / "set/set.jsonl", text("set/set.jsonl").size() - 40);
  const Outcome outcome = make("0:3");
  expect_made(outcome, "1 made, 2 already there");
  EXPECT_TRUE(has(outcome.errors, "1 line cut short"));
  EXPECT_EQ(manifest(), before);
}

TEST_F(SynthMembers, AMemberThatFailsIsNamedAndTheOthersGoOn) {
  // A folder stands where a member's mesh should be.
  std::filesystem::create_directories(folder_ / "set/body_0000001.ply");
  const Outcome outcome = make("0:3");
  EXPECT_EQ(outcome.status, 1) << outcome.errors;
  EXPECT_TRUE(has(outcome.errors, "synth: member 1: "));
  EXPECT_TRUE(has(outcome.errors, "2 made, 0 already there, 1 failed, of 3"));
  EXPECT_EQ(manifest().size(), 2u);
}

TEST_F(SynthMembers, WrongRequestsAreRefusedBeforeAnyWork) {
  const std::string outputs = " -o {member}.ply --manifest m.jsonl";
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  refuse_all(
      "r.json --members ",
      {{"5:5" + outputs, "--members: 5:5 holds no member"},
       {"7:5" + outputs, "--members: 7:5 holds no member"},
       {"-1:5" + outputs, "--members: must be A:B"},
       {"0:9007199254740993" + outputs, "--members: must be A:B"},
       {"12" + outputs, "--members: must be A:B"},
       {"0:2 -o body.ply --manifest m.jsonl", "--output: every member writes"},
       {"0:2 --preview {member}.png --preview-maps a.npz" + outputs, "--preview-maps: every member writes"},
       {"0:2 -o {member}.ply --manifest \"\"", "--manifest: is given without a name"},
       {"0:2 --manifest m.jsonl --out \"\"", "--out: is given without a name"},
       {"0:2 --write-recipe {member}.astro --preview {member}.png --manifest m.jsonl",
        "--write-recipe without -o keeps recipes alone"},
       {"0:2 --predict -o {member}.obj --labels", ".ply"},
       {"0:2 --predict -o {member}.foo", "{member}.foo"},
       // Options that contradict each other are no failure of each member.
       {"0:2 --labels --gravity 2000 8" + outputs, "--gravity: is of the whole body"},
       {"0:2 --gravity -1 8" + outputs, "--gravity: the density must be above 0"},
       {"0:2 --predict --labels --gravity 2000 8", "--gravity: is of the whole body"},
       {"0:2 -o {member}.ply --manifest pipe",
        "pipe is a folder, a device or a pipe; give the name of a file"},
       {"0:2 -o {member}.ply --manifest 0000012.ply", "is the name of two outputs"}});
}

// Without a family a member is the body that --seed makes of its number, and needs no manifest.
TEST_F(SynthMembers, BodiesOfOneRecipeDifferByTheirSeeds) {
  write("r.json", replaced(kFamily, kFamily.substr(kFamily.find(",\n  \"family\"")), "}"));
  succeed("r.json --resolution 24 --members 5:7 -o plain_{member}.ply --preview p_{member}.png");
  succeed("r.json --resolution 24 --seed 6 -o single.ply");
  EXPECT_TRUE(text("single.ply") == text("plain_0000006.ply"));
  EXPECT_TRUE(exists("p_0000005.png") && exists("p_0000006.png"));
  EXPECT_EQ(folder_.files().size(), 6u);
  refuse("r.json --members 0:2 --seed 3 -o {member}.ply",
         "--seed: bodies of --members have their numbers as seeds");
}

TEST_F(SynthMembers, VariationsAreMadeByTheirNumbers) {
  write("r.json", kTwoSpheres);
  const std::string vary = "r.json --resolution 24 --vary 0.9 ";
  succeed(vary + "--seed 1 -o single.glb --write-recipe single.json");
  succeed(vary + "--members 1:3 -o rock_{member}.glb --write-recipe rock_{member}.json --manifest m.jsonl");
  EXPECT_TRUE(text("single.glb") == text("rock_0000001.glb"));
  EXPECT_TRUE(text("single.json") == text("rock_0000001.json"));
  EXPECT_FALSE(text("rock_0000001.glb") == text("rock_0000002.glb"));
  EXPECT_TRUE(has(text("m.jsonl"), "\"similarity\":"));
}

TEST_F(SynthMembers, MarksAndTheFormerOptionAreExplained) {
  refuse("r.json -o rock_{member}.ply", "{member} stands for the number of each body of --members A:B");
  refuse("r.json --count 2 -o rock_{n}.ply", "--count: is gone; write --members A:B");
}

TEST_F(SynthMembers, BothWaysToNameFilesGoOnWithOneSet) {
  expect_made(run("r.json --members 0:1 --out one --manifest m.jsonl"), "1 made");
  expect_made(run("r.json --members 0:2 -o one/{member}.ply --manifest m.jsonl"), "1 made");
}

}  // namespace
}  // namespace astrolith
