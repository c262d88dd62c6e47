// SPDX-License-Identifier: Apache-2.0
// make_demo still-life|lambertian|conductors|glass OUT.glb
// make_demo terrace|terrace-photograph|terrace-whole OUT.glb
// make_demo dusk|noon OUT.exr
#include <iostream>

#include "base/error.h"
#include "dusk.h"
#include "image/io/write_image.h"
#include "still_life.h"
#include "terrace.h"

int main(int argc, char** argv) {
  using namespace chromeball;
  const std::string what = argc == 3 ? argv[1] : "";
  try {
    if (what == "still-life")
      demo::writeStillLife(argv[2], demo::Finish::Demo);
    else if (what == "lambertian")
      demo::writeStillLife(argv[2], demo::Finish::Lambertian);
    else if (what == "conductors")
      demo::writeStillLife(argv[2], demo::Finish::Conductors);
    else if (what == "glass")
      demo::writeStillLife(argv[2], demo::Finish::Glass);
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
          "still-life|lambertian|conductors|glass|terrace|terrace-photograph|terrace-whole "
          "OUT.glb, or dusk|noon OUT.exr");
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
