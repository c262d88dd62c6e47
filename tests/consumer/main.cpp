// SPDX-License-Identifier: Apache-2.0
// Renders a scene file to an array of floats and prints the image's size and its mean colour.
#include <chromeball/render.h>

#include <cstdio>
#include <vector>

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: consumer SCENE.toml\n"), 2;
  chromeball::Session session(chromeball::planRender(chromeball::openScene(argv[1])));
  session.start();

  // Radiance, linear Rec. 709: red, green and blue of the top left pixel first.
  const chromeball::Image& image = session.wait().color();
  const std::vector<float>& radiance = image.texels;
  double sum[3] = {};
  for (size_t i = 0; i < radiance.size(); ++i) sum[i % 3] += radiance[i];
  const double pixels = double(image.width) * image.height;
  std::printf("%d %d %.9g %.9g %.9g\n", image.width, image.height, sum[0] / pixels, sum[1] / pixels,
              sum[2] / pixels);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
