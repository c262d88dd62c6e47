// SPDX-License-Identifier: Apache-2.0
// make_demo still-life|lambertian|conductors|glass|plastics|room|lamp|caustics|fine OUT.glb
// make_demo terrace|terrace-photograph|terrace-whole OUT.glb
// make_demo dusk|noon OUT.exr
#include <iostream>
#include <map>

#include "base/error.h"
#include "dusk.h"
#include "image/io/write_image.h"
#include "still_life.h"
#include "terrace.h"

namespace {

using chromeball::demo::Finish;

const std::map<std::string, Finish> kFinishes = {{"still-life", Finish::Demo},
                                                 {"lambertian", Finish::Lambertian},
                                                 {"conductors", Finish::Conductors},
                                                 {"glass", Finish::Glass},
                                                 {"plastics", Finish::Plastics},
                                                 {"room", Finish::Room},
                                                 {"lamp", Finish::Lamp},
                                                 {"caustics", Finish::Caustics},
                                                 {"fine", Finish::Fine}};

}  // namespace

int main(int argc, char** argv) {
  using namespace chromeball;
  const std::string what = argc == 3 ? argv[1] : "";
  try {
    if (const auto finish = kFinishes.find(what); finish != kFinishes.end())
      demo::writeStillLife(argv[2], finish->second);
    else if (what == "terrace")
      demo::writeTerrace(argv[2], demo::Terrace::Model);
    else if (what == "terrace-photograph")
      demo::writeTerrace(argv[2], demo::Terrace::Photograph);
    else if (what == "terrace-whole")
      demo::writeTerrace(argv[2], demo::Terrace::Whole);
    else if (what == "noon")
      writeImage(argv[2], demo::terraceProbe(768));
    else if (what == "dusk")
      writeImage(argv[2], demo::paintDusk(1536));
    else
      throwInput(
          "make_demo: "
          "still-life|lambertian|conductors|glass|plastics|room|lamp|caustics|fine|"
          "terrace|terrace-photograph|terrace-whole OUT.glb, or dusk|noon OUT.exr");
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
