// SPDX-License-Identifier: Apache-2.0
#include "front/sequence.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>

#include <fmt/format.h>

#include "base/error.h"

namespace chromeball {
namespace {

constexpr int kLargestNumber = 1'000'000;

struct FrameRange {
  int first = 0, last = 0, step = 1;
};

// "A:B" or "A:B:STEP".
FrameRange rangeOf(const Settings& given) {
  const auto text = given.get<std::string>("frames");
  static const std::regex form("([0-9]{1,7}):([0-9]{1,7})(:([0-9]{1,7}))?");
  std::smatch match;
  FrameRange range;
  if (std::regex_match(text, match, form)) {
    range.first = std::stoi(match[1]), range.last = std::stoi(match[2]);
    if (match[4].matched) range.step = std::stoi(match[4]);
    if (range.first <= range.last && range.last <= kLargestNumber && range.step > 0) return range;
  }
  throwInput(
      "{}: `{}` are no frames; give A:B or A:B:STEP, such as 0:47, of "
      "numbers up to {}",
      given.location("frames"), text, kLargestNumber);
}

void nameFiles(Settings& settings, int number) {
  const auto named = [&](const std::string& name, const std::string& path) {
    const std::string result = withNumber(path, number);
    if (result == path)
      throwInput("{}: `{}` has no # for the number of the frame, as in frame.####.exr",
                 settings.location(name), path);
    return result;
  };
  if (auto paths = settings.getIfGiven<std::vector<std::string>>("output.file")) {
    for (std::string& path : *paths) path = named("output.file", path);
    settings.set("output.file", *paths, settings.location("output.file"));
  }
  for (const char* name : {"stats", "noise-map", "checkpoint"})
    if (const auto path = settings.getIfGiven<std::string>(name))
      settings.set(name, named(name, *path), settings.location(name));
  if (const auto path = settings.getIfGiven<std::string>("cache"))  // frames may share one
    settings.set("cache", withNumber(*path, number), settings.location("cache"));
}

void check(const Settings& all, const Settings& given) {
  const auto refuse = [&](const char* name, const char* why) {
    if (given.has(name)) throwInput("{}: {}", given.location(name), why);
  };
  if (!given.has("frames")) {
    for (const char* name : {"frame", "overwrite", "seed-per-frame", "probe-sequence"})
      refuse(name, "needs --frames A:B");
    if (!all.has("camera.shutter")) refuse("fps", "needs --frames A:B or --shutter");
    return;
  }
  refuse("model.time", "frames have times of their own; leave one of the two out");
  refuse("orbit-step", "frames turn by --orbit; leave one of the two out");
  if (given.has("probe-sequence")) {
    refuse("probe.file", "each frame has a probe of --probe-sequence; leave one of the two out");
    const auto pattern = given.get<std::string>("probe-sequence");
    if (withNumber(pattern, 0) == pattern)
      throwInput("{}: `{}` has no # for the number of the frame, as in probe.####.exr",
                 given.location("probe-sequence"), pattern);
  }
  refuse("write-every", "a frame is written when it is finished");
}

}  // namespace

std::string withNumber(const std::string& pattern, int number) {
  const size_t last = pattern.rfind('#');
  if (last == std::string::npos) return pattern;
  const size_t begin = pattern.find_last_not_of('#', last) + 1;  // 0 if there is no other character
  return pattern.substr(0, begin) + fmt::format("{:0{}}", number, last + 1 - begin) +
         pattern.substr(last + 1);
}

Sequence::Sequence(const SceneFile& scene, const Settings& given)
    : scene_(scene), given_(given), all_(scene.settings) {
  all_.merge(given);
  check(all_, given);
  if (!given.has("frames")) return;
  const FrameRange range = rangeOf(given);
  for (int number = range.first; number <= range.last; number += range.step)
    numbers_.push_back(number);
  first_ = range.first;
  end_ = numbers_.back() + range.step;
  const auto only = given.getIfGiven<uint64_t>("frame");
  if (!only) return;
  if (*only > kLargestNumber || !std::ranges::binary_search(numbers_, int(*only)))
    throwInput("{}: {} is not one of the frames {}", given.location("frame"), *only,
               given.get<std::string>("frames"));
  numbers_ = {int(*only)};
}

SequenceFrame Sequence::frame(int number) const {
  SequenceFrame frame{number, scene_, given_};
  if (given_.has("output.file")) frame.scene.settings.erase("output.file");
  nameFiles(frame.scene.settings, number);
  nameFiles(frame.given, number);
  Settings& s = frame.given;
  s.set("model.time", number / all_.get<double>("fps"), "--frames");
  for (const char* name : {"orbit", "turntable"})
    if (const auto turn = all_.getIfGiven<double>(name))
      s.set(name, *turn * (number - first_) / (end_ - first_), given_.location(name));
  if (const auto orbit = all_.getIfGiven<double>("orbit"); orbit && all_.has("camera.shutter"))
    s.set("orbit-step", *orbit / (end_ - first_), "--orbit");
  if (const auto pattern = all_.getIfGiven<std::string>("probe-sequence")) {
    s.set("probe.file", withNumber(*pattern, number), given_.location("probe-sequence"));
    s.erase("probe-sequence");
  }
  if (all_.get<bool>("seed-per-frame"))
    s.set("render.seed", all_.get<uint64_t>("render.seed") + uint64_t(number), "--seed-per-frame");
  return frame;
}

namespace {

// A still that is turned by whole turns, and files that are named as those of frames.
void addStillNotes(const Settings& all, Messages& messages) {
  for (const char* name : {"orbit", "turntable"})
    if (const auto turn = all.getIfGiven<double>(name);
        turn && *turn != 0 && std::fmod(*turn, 360) == 0)
      addNote(messages,
              "{}: a turn of {:g} degrees leaves this one image as it is; --frames A:B makes a "
              "sequence of images on the way",
              all.location(name), *turn);
  for (const std::string& path : all.get<std::vector<std::string>>("output.file"))
    if (std::filesystem::path(path).filename().string().find('#') != std::string::npos)
      addNote(messages, "{}: `{}` is this one image's name; # becomes a number with --frames A:B",
              all.location("output.file"), path);
}

}  // namespace

Messages Sequence::messages() const {
  Messages messages;
  if (numbers_.empty()) addStillNotes(all_, messages);
  for (size_t i = 0; !numbers_.empty() && i < scene_.models.size(); ++i)
    if (const std::string time = elementName("models", i) + ".choice.animation.seconds";
        scene_.origins.has(time))
      addWarning(messages, "{}: `time` has no effect: frames have times of their own",
                 scene_.origins.of(time));
  return messages;
}

}  // namespace chromeball
