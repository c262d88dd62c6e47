// chromeball image error A B
#include <cstdio>
#include <nlohmann/json.hpp>

#include "image/read.h"
#include "image_commands.h"
#include "math/error.h"
#include "measure/image_error.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string a, b;
  bool json = false;
};

// JSON has no infinity: null there.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json toJson(const ImageError& error) {
  Json json = {{"mse", number(error.mse)},   {"relmse", number(error.relMse)},
               {"bias", number(error.bias)}, {"max_difference", number(error.maxDifference)},
               {"psnr", number(error.psnr)}, {"invalid", error.invalid}};
  if (const auto& z = error.zScores)
    json["z"] = {{"count", z->count},
                 {"mean", number(z->mean)},
                 {"sd", number(z->standardDeviation)},
                 {"beyond_3_sigma", number(z->shareBeyond3)}};
  return json;
}

void print(const ImageError& error) {
  fmt::print("mse             {:.6g}\n", error.mse);
  fmt::print("relmse          {:.6g}\n", error.relMse);
  fmt::print("bias            {:.6g}\n", error.bias);
  fmt::print("max difference  {:.6g}\n", error.maxDifference);
  fmt::print("psnr            {:.4g} dB\n", error.psnr);
  if (error.invalid > 0) fmt::print("invalid         {} numbers left out\n", error.invalid);
  if (const auto& z = error.zScores)
    fmt::print("z               mean {:.4g}, sd {:.4g}, {:.4g}% beyond 3 sigma, of {} numbers\n",
               z->mean, z->standardDeviation, 100 * z->shareBeyond3, z->count);
}

struct Side {
  Image color;
  std::optional<Image> variance;

  explicit Side(const std::string& path) {
    const ImageFile file = readImageFile(path);
    std::optional<Image> found = findColor(file);
    if (!found) throwInput("{}: has no colour", path);
    color = *std::move(found);
    variance = findLayer(file, "variance");
  }
  const Image* varianceOrNull() const { return variance ? &*variance : nullptr; }
};

void run(const Arguments& arguments) {
  const Side a(arguments.a), b(arguments.b);
  if (a.color.width != b.color.width || a.color.height != b.color.height)
    throwInput("{}: is {} x {}, but {} is {} x {}; only images of one size can be compared",
               arguments.a, a.color.width, a.color.height, arguments.b, b.color.width,
               b.color.height);
  const ImageError error = imageError(a.color, b.color, a.varianceOrNull(), b.varianceOrNull());
  if (arguments.json)
    fmt::print("{}\n", toJson(error).dump(2));
  else
    print(error);
}

}  // namespace

void addImageErrorCommand(CLI::App& image) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = image.add_subcommand("error", "How far image A is from the reference B.");
  command->add_option("A", arguments->a, "the image")->required();
  command->add_option("B", arguments->b, "the reference")->required();
  command->add_flag("--json", arguments->json, "print JSON");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
