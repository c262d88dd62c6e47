// SPDX-License-Identifier: Apache-2.0
// make_demo WHAT OUT: writes a model (.glb) or a probe of the demo and the gallery.
#include <functional>
#include <iostream>
#include <map>

#include "base/error.h"
#include "base/file.h"
#include "dusk.h"
#include "gallery.h"
#include "image/io/write_image.h"
#include "nave.h"
#include "still_life.h"
#include "terrace.h"

namespace {

using namespace chromeball::demo;
using Write = std::function<void(const std::string& path)>;

Write stillLife(Finish finish) {
  return [finish](const std::string& path) { writeStillLife(path, finish); };
}

Write terrace(Terrace what) {
  return [what](const std::string& path) { writeTerrace(path, what); };
}

Write nave(Nave what) {
  return [what](const std::string& path) { writeNave(path, what); };
}

const std::map<std::string, Write> kModels = {{"still-life", stillLife(Finish::Demo)},
                                              {"lambertian", stillLife(Finish::Lambertian)},
                                              {"conductors", stillLife(Finish::Conductors)},
                                              {"glass", stillLife(Finish::Glass)},
                                              {"plastics", stillLife(Finish::Plastics)},
                                              {"room", stillLife(Finish::Room)},
                                              {"lamp", stillLife(Finish::Lamp)},
                                              {"caustics", stillLife(Finish::Caustics)},
                                              {"fine", stillLife(Finish::Fine)},
                                              {"terrace", terrace(Terrace::Model)},
                                              {"terrace-photograph", terrace(Terrace::Photograph)},
                                              {"terrace-whole", terrace(Terrace::Whole)},
                                              {"five-shapes", writeFiveShapes},
                                              {"rnl", writePedestal},
                                              {"temple", writeTemple},
                                              {"nave", nave(Nave::Whole)},
                                              {"nave-room", nave(Nave::Room)},
                                              {"nave-things", nave(Nave::Things)}};

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
