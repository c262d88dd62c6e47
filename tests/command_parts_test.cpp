// SPDX-License-Identifier: Apache-2.0
// chromeball render --shard, --crop, --checkpoint, --resume, and chromeball merge.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "base/hash.h"
#include "base/progress.h"
#include "image/io/read_image.h"
#include "measure/image_error.h"
#include "paths.h"
#include "run_command.h"

namespace chromeball::command_parts_test {
namespace {

using Words = std::vector<std::string>;

// The demo's model under its probe, small.
class Parts {
 public:
  const TemporaryFolder out;

  Words words(const Words& more, const std::string& output) const {
    Words all{"render",      std::string(kSourceDir) + "/scenes/demo.toml",
              "--max-depth", "4",
              "-o",          output,
              "--aov",       "albedo,samples,variance"};
    if (!std::ranges::count(more, "--size")) all.insert(all.end(), {"--size", "48x32"});
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

// The command, which runs while the test continues.
class Child {
 public:
  explicit Child(const Words& words) {
    std::vector<char*> argv{const_cast<char*>(kCommand)};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    id_ = fork();
    if (id_ != 0) return;
    dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    dup2(STDOUT_FILENO, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~Child() {
    if (!ended_) kill();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  // The exit status, once the command has ended.
  std::optional<int> status() {
    int status = 0;
    if (waitpid(id_, &status, WNOHANG) != id_) return {};
    ended_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  void kill() {
    ::kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
    ended_ = true;
  }

 private:
  pid_t id_;
  bool ended_ = false;
};

double relMse(const std::string& a, const std::string& b) {
  return imageError(readImage(a), readImage(b), nullptr, nullptr).relMse;
}

void expectSameImage(const std::string& a, const std::string& b) {
  const ImageFile first = readImageFile(a), second = readImageFile(b);
  EXPECT_EQ(first.channels, second.channels);
  EXPECT_EQ(first.image.texels, second.image.texels);
}

TEST(SlowMerge, OfShardsIsTheWholeImage) {
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
  for (const char* name : {"shard", "samplesOfAll"}) EXPECT_EQ(merged.metadata.count(name), 0u);
  for (const std::string& part : {a, b, c})
    EXPECT_EQ(metadataNumber(readImageFile(part).metadata, "samplesOfAll"), 30) << part;
  EXPECT_EQ(single.metadata.count("samplesOfAll"), 0u);
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

TEST(SlowMerge, OfCropsIsTheWholeImage) {
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

// Large parts are read in bands of rows; the last band may be smaller.
// The header states the mean over the pixels.
TEST(SlowMerge, OfCropsWithOtherNumbersOfSamples) {
  const Parts parts;
  const std::string many = parts.renderOnly("m.exr", {"--samples", "64", "--crop", "0,0,12,32"});
  const std::string few = parts.renderOnly("f.exr", {"--samples", "16", "--crop", "12,0,36,32"});
  for (const Words& order : {Words{many, few}, Words{few, many}})
    EXPECT_EQ(metadataNumber(readImageFile(parts.merge("all.exr", order)).metadata, "samples"), 28);
}

// A shard whose limit is met by the samples that all repeat goes on to some of its own.
TEST(SlowMerge, OfShardsThatALimitEndsEarly) {
  const Parts parts;
  for (const Words& limit : {Words{"--noise", "60"}, Words{"--time", "0.001"}}) {
    Words shards;
    for (const char* which : {"1/3", "2/3", "3/3"}) {
      Words words = limit;
      words.insert(words.end(), {"--shard", which});
      shards.push_back(parts.renderOnly(std::string(which, 1) + ".exr", words));
      EXPECT_EQ(readImageFile(shards.back()).metadata.count("samplesOfAll"), 0u);
    }
    EXPECT_GE(metadataNumber(readImageFile(parts.merge("all.exr", shards)).metadata, "samples"),
              32);
  }
}

TEST(SlowMerge, OfLargePartsIsTheWholeImage) {
  const Parts parts;
  const auto part = [&](const std::string& name, const Words& more) {
    Words words{"--size", "150x230"};
    words.insert(words.end(), more.begin(), more.end());
    return parts.render(name, words);
  };
  const Words fixed{"--adaptive", "off", "--guide", "off", "--samples", "8"};
  const auto fixedPart = [&](const std::string& name, Words words) {
    words.insert(words.end(), fixed.begin(), fixed.end());
    return part(name, words);
  };
  const std::string whole = fixedPart("whole.exr", {});
  const std::string top = fixedPart("top.exr", {"--crop", "0,0,150,31"});
  const std::string left = fixedPart("left.exr", {"--crop", "0,31,41,199"});
  const std::string right = fixedPart("right.exr", {"--crop", "41,31,109,199"});
  expectSameImage(parts.merge("crops.exr", {right, top, left}), whole);
  const std::string a = fixedPart("a.exr", {"--shard", "1/2"});
  const std::string b = fixedPart("b.exr", {"--shard", "2/2"});
  EXPECT_LT(relMse(parts.merge("shards.exr", {b, a}), whole), 1e-12);

  // With guides, the first samples of a pixel have another weight.
  const std::string c = part("c.exr", {"--guide", "on", "--shard", "1/2", "--samples", "64"});
  const std::string d = part("d.exr", {"--guide", "on", "--shard", "2/2", "--samples", "64"});
  const std::string cd = parts.merge("cd.exr", {c, d});
  expectSameImage(cd, parts.merge("dc.exr", {d, c}));
  EXPECT_LT(relMse(cd, whole), relMse(c, whole));
}

// The layers' names and the clamped light of the whole are reported as for one render.
TEST(SlowMerge, KeepsWhatIsKnownAboutTheParts) {
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
TEST(SlowMerge, FindsDamagedHeaders) {
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

TEST(SlowMerge, DenoisesAndComposites) {
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

TEST(SlowParts, RefuseWhatIsNoPart) {
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
  refuse({"--resume"}, "needs a checkpoint; see --checkpoint");
  refuse({"--checkpoint", parts.out / "c.png"}, "must end in .exr");
  refuse({"--checkpoint", o}, "overwrite");
  refuse({"--checkpoint", parts.out / "./o.exr"}, "overwrite");
  expectError(parts.words({"--shard", "1/2"}, parts.out / "o.png"), "needs an .exr");
}

TEST(SlowParts, ACropIsNoShard) {
  const Parts parts;
  const std::string crop = parts.renderOnly("c.exr", {"--samples", "8", "--crop", "0,0,12,32"});
  const std::string shard = parts.renderOnly("s.exr", {"--samples", "8", "--shard", "1/2"});
  expectError({"merge", shard, crop, "-o", parts.out / "m.exr"}, "c.exr: is no shard");
}

TEST(SlowCheckpoint, GoesOnAfterAnInterrupt) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  const Words description{"--samples", "1000", "--seed", "3", "--guide", "off"};
  const std::string whole = parts.render("whole.exr", description);
  Words resumed = description;
  resumed.insert(resumed.end(), {"--checkpoint", checkpoint, "--resume", "--progress"});
  int interrupts = 0;
  for (CommandResult result; interrupts < 100; ++interrupts) {
    result = runExecutable(parts.words(resumed, parts.out / "image.exr"), "rendering", SIGINT);
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
  Words again = description;
  again.insert(again.end(), {"--checkpoint", checkpoint});
  expectError(parts.words(again, parts.out / "o.exr"), "--resume");
}

// Another number of all samples would give it samples of other shards.
// Also of a render that ends where the guides would begin.
TEST(SlowCheckpoint, OfFewSamplesIsWrittenAndContinued) {
  const Parts parts;
  for (const char* samples : {"7", "8", "16"}) {
    const std::string file = parts.out / (std::string(samples) + "-state.exr");
    parts.renderOnly("some.exr", {"--samples", samples, "--checkpoint", file});
    ASSERT_TRUE(std::filesystem::exists(file)) << samples;
    const std::string more =
        parts.renderOnly("more.exr", {"--samples", "32", "--checkpoint", file, "--resume"});
    EXPECT_EQ(metadataNumber(readImageFile(more).metadata, "samples"), 32) << samples;
  }
}

// A file with another name is no change of its contents.
TEST(SlowCheckpoint, OfAnotherFileSaysSo) {
  const Parts parts;
  const std::string state = parts.out / "state.exr", copy = parts.out / "copy.exr";
  const std::string probe = std::string(kSourceDir) + "/probes/noon.exr";
  std::filesystem::copy_file(probe, copy);
  const auto words = [&](const std::string& file) {
    return Words{"render",       std::string(kSourceDir) + "/scenes/models/pillars.gltf",
                 "--probe",      file,
                 "--size",       "8x8",
                 "--samples",    "4",
                 "--checkpoint", state,
                 "-o",           parts.out / "o.exr"};
  };
  EXPECT_EQ(runCommand(words(probe)).status, 0);
  Words other = words(copy);
  other.push_back("--resume");
  expectError(other, "only one of them reads");
}

TEST(SlowCheckpoint, OfAShardKeepsItsNumberOfSamples) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  const auto shardOf = [&](const char* samples) {
    return Words{"--samples", samples, "--shard", "2/2", "--checkpoint", checkpoint, "--resume"};
  };
  parts.render("o.exr", shardOf("32"));
  expectError(parts.words(shardOf("64"), parts.out / "o.exr"), "`samples` was 32 and is 64");
  parts.render("o.exr", shardOf("32"));
}

// Killed 20 times at any moment, a render continues from its last checkpoint and ends with the same
// bits; and so does the next one, if the machine is so fast that it ends before.
TEST(SlowCheckpoint, SurvivesKills) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr", image = parts.out / "image.exr";
  const Words description{"--samples", "250", "--size", "24x16"};
  const std::string whole = parts.out / "whole.exr";
  const Stopwatch watch;
  EXPECT_EQ(runExecutable(parts.words(description, whole)).status, 0);
  const double seconds = watch.seconds();
  Words resumed = description;
  resumed.insert(resumed.end(),
                 {"--checkpoint", checkpoint, "--resume", "--checkpoint-every", "0.01"});
  int kills = 0, writes = 0;
  std::string before;
  for (uint64_t start = 0; (kills < 20 || writes < 5) && start < 200; ++start) {
    Child child(parts.words(resumed, image));
    usleep(useconds_t(1e6 * seconds * (0.3 + toUnit(uint32_t(hash(start) >> 32)))));
    if (const auto status = child.status()) {
      EXPECT_EQ(*status, 0);
      expectSameImage(image, whole);
      std::filesystem::remove(checkpoint);
    } else {
      child.kill();
      ++kills;
      writes += std::filesystem::exists(checkpoint) && fileContents(checkpoint) != before;
      before = fileContents(checkpoint);
    }
  }
  EXPECT_GE(kills, 20);
  EXPECT_GE(writes, 5);
  parts.render("image.exr", resumed);
  expectSameImage(image, whole);
  EXPECT_EQ(parts.out.files(), (Words{"c.exr", "image.exr", "whole.exr"}));  // nothing is left
}

TEST(SlowCheckpoint, IsOfOneProcess) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  Child child(parts.words({"--samples", "1000000", "--checkpoint", checkpoint, "--quiet"},
                          parts.out / "first.exr"));
  while (!std::filesystem::exists(checkpoint + ".lock")) usleep(10'000);
  usleep(100'000);
  expectError(parts.words({"--checkpoint", checkpoint}, parts.out / "o.exr"), "another process");
  child.kill();
  parts.render("o.exr", {"--samples", "4", "--checkpoint", checkpoint});  // the lock is free
}

TEST(SlowCheckpoint, TellsThatItHasMoreSamplesThanAskedFor) {
  const Parts parts;
  const Words description{"--checkpoint", parts.out / "c.exr", "--resume", "--guide",
                          "off",          "--samples"};
  const auto render = [&](const std::string& samples) {
    Words words = description;
    words.push_back(samples);
    return runCommand(parts.words(words, parts.out / "o.exr"));
  };
  EXPECT_EQ(render("8").error.find("asked for"), std::string::npos);
  const CommandResult fewer = render("4");
  EXPECT_EQ(fewer.status, 0);
  EXPECT_NE(fewer.error.find("c.exr has 8 samples per pixel, more than the 4 asked for"),
            std::string::npos)
      << fewer.error;
  EXPECT_EQ(std::get<int>(readImageFile(parts.out / "o.exr").metadata.at("samples")), 8);
  EXPECT_EQ(render("16").error.find("asked for"), std::string::npos);
}

// Names of files may hold any byte but 0 and /.
TEST(Parts, MayHaveNamesThatAreNotUtf8) {
  const Parts parts;
  const std::string folder = parts.out / "caf\xe9";
  std::filesystem::create_directory(folder);
  const std::string model = folder + "/model.glb", probe = folder + "/probe.exr";
  std::filesystem::copy(std::string(kSourceDir) + "/scenes/models/still-life.glb", model);
  std::filesystem::copy(std::string(kSourceDir) + "/probes/dusk.exr", probe);
  const std::string part = folder + "/part.exr", stats = folder + "/stats.json";
  const CommandResult rendered =
      runCommand({"render", model, "--probe", probe, "--size", "24x16", "--samples", "4", "--shard",
                  "1/1", "--checkpoint", folder + "/c.exr", "--stats", stats, "-o", part});
  EXPECT_EQ(rendered.status, 0) << rendered.error;
  EXPECT_NE(fileContents(stats).find("caf\xef\xbf\xbd/model.glb"), std::string::npos);
  const CommandResult merged = runCommand({"merge", part, "-o", folder + "/o.exr"});
  EXPECT_EQ(merged.status, 0) << merged.error;
  EXPECT_NE(merged.out.find("of 1 part,"), std::string::npos) << merged.out;
}

// If the disk is full while a checkpoint is written, the previous one stays.
TEST(SlowCheckpoint, StaysWhereTheDiskIsFull) {
  const Parts parts;
  const std::string checkpoint = parts.out / "c.exr";
  parts.render("o.exr", {"--samples", "4", "--checkpoint", checkpoint});
  const std::string before = fileContents(checkpoint);
  const CommandResult result = runExecutable(
      parts.words({"--samples", "8", "--checkpoint", checkpoint, "--resume"}, parts.out / "o.exr"),
      "", SIGINT, {.fileSize = 20'000});
  EXPECT_EQ(result.status, 1) << result.error;
  EXPECT_EQ(fileContents(checkpoint), before);
}

TEST(SlowWriteEvery, WritesImagesThatGrow) {
  const Parts parts;
  const std::string path = parts.out / "growing.exr";
  Child child(parts.words({"--samples", "1000000", "--write-every", "0.1", "--quiet"}, path));
  const auto samples = [&] { return std::get<int>(readImageFile(path).metadata.at("samples")); };
  for (int i = 0; i < 10'000 && !std::filesystem::exists(path); ++i) usleep(10'000);
  const int first = samples();
  int last = first;
  for (int i = 0; i < 10'000 && last <= first; ++i) usleep(10'000), last = samples();
  EXPECT_GT(first, 0);
  EXPECT_GT(last, first);
  child.kill();
}

}  // namespace
}  // namespace chromeball::command_parts_test
