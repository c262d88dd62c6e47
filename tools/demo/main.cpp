// SPDX-License-Identifier: Apache-2.0
// make_demo WHAT OUT: writes a model (.glb) or a probe of the demo and the gallery.
#include <functional>
#include <iostream>
#include <map>

#include "base/error.h"
#include "base/file.h"
#include "gallery.h"
#include "image/io/write_image.h"

namespace {

using namespace chromeball::demo;
using Write = std::function<void(const std::string& path)>;

template <class What>
Write as(void (*write)(const std::string&, What), What what) {
  return [=](const std::string& path) { write(path, what); };
}

const std::map<std::string, Write> kModels = {
    {"still-life", as(writeStillLife, Finish::Demo)},
    {"lambertian", as(writeStillLife, Finish::Lambertian)},
    {"conductors", as(writeStillLife, Finish::Conductors)},
    {"glass", as(writeStillLife, Finish::Glass)},
    {"plastics", as(writeStillLife, Finish::Plastics)},
    {"room", as(writeStillLife, Finish::Room)},
    {"lamp", as(writeStillLife, Finish::Lamp)},
    {"caustics", as(writeStillLife, Finish::Caustics)},
    {"fine", as(writeStillLife, Finish::Fine)},
    {"terrace", as(writeTerrace, Terrace::Model)},
    {"terrace-photograph", as(writeTerrace, Terrace::Photograph)},
    {"terrace-whole", as(writeTerrace, Terrace::Whole)},
    {"five-shapes", writeFiveShapes},
    {"rnl", writePedestal},
    {"temple", writeTemple},
    {"nave", as(writeNave, Nave::Whole)},
    {"nave-room", as(writeNave, Nave::Room)},
    {"nave-things", as(writeNave, Nave::Things)}};

const std::map<std::string, chromeball::Image (*)()> kProbes = {
    {"dusk", [] { return paintDusk(1536); }}, {"noon", [] { return terraceProbe(768); }}};

template <class T>
std::string namesOf(const std::map<std::string, T>& table) {
  std::string names;
  for (const auto& [name, entry] : table) names += (names.empty() ? "" : "|") + name;
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace chromeball;
  try {
    const std::string what = argc == 3 ? argv[1] : "";
    const auto model = kModels.find(what);
    const auto probe = kProbes.find(what);
    if (model == kModels.end() && probe == kProbes.end())
      throwInput("make_demo: {} OUT.glb, or {} OUT.exr", namesOf(kModels), namesOf(kProbes));
    const char* extension = model != kModels.end() ? ".glb" : ".exr";
    if (lowerExtension(argv[2]) != extension)
      throwInput("make_demo: {} should end in {}", argv[2], extension);
    checkReplaceable(argv[2]);
    if (model != kModels.end())
      model->second(argv[2]);
    else
      writeImage(argv[2], probe->second());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return dynamic_cast<const InputError*>(&error) ? 2 : 1;
  }
}
