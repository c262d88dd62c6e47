// SPDX-License-Identifier: Apache-2.0
// chromeball render --shard, --crop, --checkpoint, --resume, and chromeball merge.
#include <gtest/gtest.h>

#include <fstream>

#include "image/io/read_image.h"
#include "measure/image_error.h"
#include "paths.h"
#include "run_command.h"

namespace chromeball {
namespace {

using Words = std::vector<std::string>;

// The demo's model under its probe, small.
class Parts {
 public:
  const TemporaryFolder out;

  Words words(const Words& more, const std::string& output) const {
    Words all{"render",      std::string(kSourceDir) + "/scenes/demo.toml",
              "--size",      "48x32",
              "--max-depth", "4",
              "-o",          output,
              "--aov",       "albedo,samples,variance"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::string render(const std::string& name, const Words& more) const {
    const std::string path = out / name;
    const CommandResult result = runCommand(words(more, path));
    EXPECT_EQ(result.status, 0) << result.error;
    return path;
  }
  std::string renderOnly(const std::string& name, const Words& more) const {
    Words all{"render",  std::string(kSourceDir) + "/scenes/demo.toml", "--size", "48x32", "-o",
              out / name};
    all.insert(all.end(), more.begin(), more.end());
    const CommandResult result = runCommand(all);
    EXPECT_EQ(result.status, 0) << result.error;
    return out / name;
  }
  std::string merge(const std::string& name, const Words& parts) const {
    Words all{"merge", "-o", out / name};
    all.insert(all.end(), parts.begin(), parts.end());
    const CommandResult result = runCommand(all);
    EXPECT_EQ(result.status, 0) << result.error;
    return out / name;
  }
};

double relMse(const std::string& a, const std::string& b) {
  return imageError(readImage(a), readImage(b), nullptr, nullptr).relMse;
}

void expectSameImage(const std::string& a, const std::string& b) {
  const ImageFile first = readImageFile(a), second = readImageFile(b);
  EXPECT_EQ(first.channels, second.channels);
  EXPECT_EQ(first.image.texels, second.image.texels);
}

TEST(Merge, OfShardsIsTheWholeImage) {
  const Parts parts;
  const Words fixed{"--samples", "30", "--adaptive", "off", "--guide", "off"};
  const auto shard = [&](const std::string& which) {
    Words words = fixed;
    words.insert(words.end(), {"--shard", which});
    return parts.render(which.substr(0, 1) + ".exr", words);
  };
  const std::string whole = parts.render("whole.exr", fixed);
  const std::string a = shard("1/3"), b = shard("2/3"), c = shard("3/3");
  const std::string abc = parts.merge("abc.exr", {a, b, c});
  EXPECT_LT(relMse(abc, whole), 1e-12);
  EXPECT_GT(relMse(a, whole), 1e-6);
  expectSameImage(abc, parts.merge("cab.exr", {c, a, b}));
  const ImageFile merged = readImageFile(abc), single = readImageFile(whole);
  EXPECT_EQ(merged.channels, single.channels);
  for (const char* name : {"samples", "rays", "size", "strategy", "max-depth"})
    EXPECT_EQ(merged.metadata.at(name), single.metadata.at(name)) << name;
  EXPECT_EQ(merged.metadata.count("shard"), 0u);
  EXPECT_NEAR(
      std::get<float>(merged.metadata.at("noise")) / std::get<float>(single.metadata.at("noise")),
      1, 1e-4);

  const std::string o = parts.out / "o.exr";
  expectError({"merge", a, b, "-o", o}, "1 of 3 shards missing: 3/3");
  expectError({"merge", a, b, c, b, "-o", o}, "is the same part as");
  expectError({"merge", a, b, whole, "-o", o}, "is no checkpoint and no part");
  Words other = fixed;
  other.insert(other.end(), {"--shard", "3/3", "--seed", "4"});
  expectError({"merge", a, b, parts.render("other.exr", other), "-o", o}, "`seed`");
  expectError({"merge", a, b, c, "-o", a}, "would overwrite");
  EXPECT_FALSE(std::filesystem::exists(o));
}

TEST(Merge, OfCropsIsTheWholeImage) {
  const Parts parts;
  const Words fixed{"--samples", "8", "--adaptive", "off", "--guide", "off"};
  const auto part = [&](const std::string& name, const Words& more) {
    Words words = fixed;
    words.insert(words.end(), more.begin(), more.end());
    return parts.render(name, words);
  };
  const std::string whole = parts.render("whole.exr", fixed);
  const std::string left = part("left.exr", {"--crop", "0,0,20,32"});
  const std::string r1 = part("r1.exr", {"--crop", "20,0,28,32", "--shard", "1/2"});
  expectError({"merge", left, r1, "-o", parts.out / "o.exr"}, "shards");
  const std::string right = part("right.exr", {"--crop", "20,0,28,32"});
  expectSameImage(parts.merge("all.exr", {right, left}), whole);
  expectError({"merge", left, "-o", parts.out / "o.exr"}, "896 of 1536 pixels");
  const std::string wide = part("wide.exr", {"--crop", "10,0,38,32"});
  expectError({"merge", left, wide, "-o", parts.out / "o.exr"}, "overlaps");
}

// The layers' names and the clamped light of the whole are told as for one render.
TEST(Merge, KeepsWhatIsKnownAboutTheParts) {
  const Parts parts;
  const auto render = [&](const std::string& name, const Words& more) {
    Words words{"--samples", "8",     "--adaptive", "off",     "--guide",
                "off",       "--aov", "material",   "--clamp", "0.5"};
    words.insert(words.end(), more.begin(), more.end());
    return parts.renderOnly(name, words);
  };
  const std::string whole = render("whole.exr", {});
  const std::string top = render("top.exr", {"--crop", "0,0,48,16"});
  const std::string bottom = render("bottom.exr", {"--crop", "0,16,48,16"});
  const CommandResult merged = runCommand({"merge", top, bottom, "-o", parts.out / "m.exr"});
  EXPECT_NE(merged.error.find("--clamp scaled"), std::string::npos) << merged.error;
  const Metadata a = readImageFile(parts.out / "m.exr").metadata, b = readImageFile(whole).metadata;
  EXPECT_EQ(a.at("manifest/material"), b.at("manifest/material"));
  EXPECT_NEAR(
      std::get<float>(a.at("clamp_light_removed")) / std::get<float>(b.at("clamp_light_removed")),
      1, 1e-4);
}

// The header of a part is read first; damage to it is not taken for a difference.
TEST(Merge, FindsDamagedHeaders) {
  const Parts parts;
  const Words fixed{"--samples", "4", "--guide", "off"};
  Words one = fixed, two = fixed;
  one.insert(one.end(), {"--shard", "1/2"});
  two.insert(two.end(), {"--shard", "2/2"});
  const std::string a = parts.render("a.exr", one), b = parts.render("b.exr", two);
  std::string bytes = fileContents(b);
  const size_t identity = bytes.rfind("\"max-depth\"");
  ASSERT_NE(identity, std::string::npos);
  bytes[identity + 1] = char(0xff);
  std::ofstream(b, std::ios::binary) << bytes;
  expectError({"merge", a, b, "-o", parts.out / "o.exr"}, "b.exr: damaged: its checksum is wrong");
}

TEST(Merge, DenoisesAndComposites) {
  const Parts parts;
  const Words denoised{"--samples", "16", "--denoise"};
  Words one = denoised, two = denoised;
  one.insert(one.end(), {"--shard", "1/2"});
  two.insert(two.end(), {"--shard", "2/2"});
  const ImageFile image =
      readImageFile(parts.merge("d.exr", {parts.render("1.exr", one), parts.render("2.exr", two)}));
  EXPECT_TRUE(findLayer(image, "noisy"));
  EXPECT_TRUE(findLayer(image, "denoise_error"));

  const auto terrace = [&](const std::string& name, const Words& more) {
    const std::string path = parts.out / name;
    Words words{"render",      std::string(kSourceDir) + "/scenes/terrace.toml",
                "--size",      "36x24",
                "--samples",   "8",
                "--adaptive",  "off",
                "--guide",     "off",
                "--max-depth", "3",
                "-o",          path};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return path;
  };
  const std::string whole = terrace("whole.exr", {});
  const std::string shards = parts.merge(
      "shards.exr", {terrace("t2.exr", {"--shard", "2/2"}), terrace("t1.exr", {"--shard", "1/2"})});
  EXPECT_LT(relMse(shards, whole), 1e-10);
  const std::string crops = parts.merge("crops.exr", {terrace("c1.exr", {"--crop", "0,0,36,10"}),
                                                      terrace("c2.exr", {"--crop", "0,10,36,14"})});
  expectSameImage(crops, whole);
}

TEST(Parts, RefuseWhatIsNoPart) {
  const Parts parts;
  const std::string o = parts.out / "o.exr";
  const auto refuse = [&](const Words& words, const std::string& reason) {
    expectError(parts.words(words, o), reason);
  };
  for (const char* text : {"0/2", "3/2", "1", "1/", "a/b", "1/2/3", "-1/2", "1/2x", ""})
    refuse({"--shard", text}, "shard");
  refuse({"--shard", "1/40", "--samples", "64"}, "less than two");
  for (const char* text : {"0,0,0,4", "0,0,4", "-1,0,4,4", "0,0,4,4,4", "a,b,c,d"})
    refuse({"--crop", text}, "crop");
  refuse({"--crop", "40,0,9,4"}, "not within the image");
  refuse({"--resume"}, "needs --checkpoint");
  refuse({"--checkpoint", parts.out / "c.png"}, "must end in .exr");
  refuse({"--checkpoint", o}, "overwrite");
  refuse({"--checkpoint", parts.out / "./o.exr"}, "overwrite");
  expectError(parts.words({"--shard", "1/2"}, parts.out / "o.png"), "needs an .exr");
}

TEST(Checkpoint, GoesOnAfterAnInterrupt) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  const Words job{"--samples", "1000", "--seed", "3", "--guide", "off"};
  const std::string whole = parts.render("whole.exr", job);
  Words resumed = job;
  resumed.insert(resumed.end(), {"--checkpoint", checkpoint, "--resume", "--progress"});
  int interrupts = 0;
  for (CommandResult result; interrupts < 100; ++interrupts) {
    result = runCommand(parts.words(resumed, parts.out / "image.exr"), "rendering", SIGINT);
    if (result.status == 0) break;
    EXPECT_EQ(result.status, 130) << result.error;
  }
  EXPECT_GT(interrupts, 0);
  parts.render("image.exr", {resumed.begin(), resumed.end()});
  expectSameImage(parts.out / "image.exr", whole);
  EXPECT_TRUE(readImage(checkpoint).width == 48);  // an image as others
  EXPECT_FALSE(std::filesystem::exists(checkpoint + ".lock"));

  Words other = resumed;
  other.insert(other.end(), {"--max-transmission-depth", "9"});
  expectError(parts.words(other, parts.out / "o.exr"), "`max-transmission-depth` was 64 and is 9");
  Words again = job;
  again.insert(again.end(), {"--checkpoint", checkpoint});
  expectError(parts.words(again, parts.out / "o.exr"), "--resume");
}

// Another number of all samples would give it samples of other shards.
TEST(Checkpoint, OfAShardKeepsItsNumberOfSamples) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  const auto shardOf = [&](const char* samples) {
    return Words{"--samples", samples, "--shard", "2/2", "--checkpoint", checkpoint, "--resume"};
  };
  parts.render("o.exr", shardOf("32"));
  expectError(parts.words(shardOf("64"), parts.out / "o.exr"), "`samples` was 32 and is 64");
  parts.render("o.exr", shardOf("32"));
}

// Killed at any moment, a render goes on from its last checkpoint and ends with the same bits.
TEST(SlowCheckpoint, SurvivesKills) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  const Words job{"--samples", "2000"};
  const std::string whole = parts.render("whole.exr", job);
  Words resumed = job;
  resumed.insert(resumed.end(),
                 {"--checkpoint", checkpoint, "--resume", "--checkpoint-every", "0.02"});
  const Words words = parts.words(resumed, parts.out / "image.exr");
  int kills = 0;
  for (bool ended = false; !ended && kills < 60;) {
    std::vector<char*> argv{const_cast<char*>(kCommand)};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
      dup2(STDOUT_FILENO, STDERR_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
    usleep(useconds_t(150'000 + 37'000 * (kills * 7 % 11)));
    int status = 0;
    ended = waitpid(child, &status, WNOHANG) == child;
    if (!ended) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      ++kills;
    } else {
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    }
  }
  EXPECT_GE(kills, 5);
  parts.render("image.exr", {resumed.begin(), resumed.end()});
  expectSameImage(parts.out / "image.exr", whole);
}

TEST(Checkpoint, IsOfOneProcess) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  const pid_t child = fork();
  if (child == 0) {
    Words words = parts.words({"--samples", "1000000", "--checkpoint", checkpoint, "--quiet"},
                              parts.out / "first.exr");
    std::vector<char*> argv{const_cast<char*>(kCommand)};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  while (!std::filesystem::exists(checkpoint + ".lock")) usleep(10'000);
  usleep(100'000);
  expectError(parts.words({"--checkpoint", checkpoint}, parts.out / "o.exr"), "another process");
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  parts.render("o.exr", {"--samples", "4", "--checkpoint", checkpoint});  // the lock is free
}

// A full disk while a checkpoint is written leaves the one before.
TEST(Checkpoint, StaysWhereTheDiskIsFull) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  parts.render("o.exr", {"--samples", "4", "--checkpoint", checkpoint});
  const std::string before = fileContents(checkpoint);
  const CommandResult result = runCommand(
      parts.words({"--samples", "8", "--checkpoint", checkpoint, "--resume"}, parts.out / "o.exr"),
      "", SIGINT, {.fileSize = 20'000});
  EXPECT_EQ(result.status, 1) << result.error;
  EXPECT_EQ(fileContents(checkpoint), before);
}

TEST(WriteEvery, WritesImagesThatGrow) {
  const Parts parts;
  const std::string path = parts.out / "growing.exr";
  const pid_t child = fork();
  if (child == 0) {
    Words words = parts.words({"--samples", "1000000", "--write-every", "0.1", "--quiet"}, path);
    std::vector<char*> argv{const_cast<char*>(kCommand)};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  const auto samples = [&] { return std::get<int>(readImageFile(path).metadata.at("samples")); };
  for (int i = 0; i < 1000 && !std::filesystem::exists(path); ++i) usleep(10'000);
  const int first = samples();
  int last = first;
  for (int i = 0; i < 1000 && last <= first; ++i) usleep(10'000), last = samples();
  EXPECT_GT(first, 0);
  EXPECT_GT(last, first);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

}  // namespace
}  // namespace chromeball
