// SPDX-License-Identifier: Apache-2.0
// EXR files of other programs: windows, layers, parts and primaries.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "composite/plate.h"
#include "image/chromaticities.h"
#include "image/io/color_channels.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "probe/capture/merge_photographs.h"
#include "probe/load.h"
#include "relight/stage/stage_file.h"
#include "temporary_folder.h"

namespace chromeball::exr_files_test {
namespace {

using Names = std::vector<std::string>;

// A part of constant channels.
struct Part {
  std::string name;
  std::vector<std::pair<std::string, float>> channels;
};

struct Windows {
  Imath::Box2i data{{0, 0}, {7, 3}}, display{{0, 0}, {7, 3}};
  float pixelAspectRatio = 1;
};

void writeParts(const std::string& path, const std::vector<Part>& parts,
                const Windows& windows = {}, std::optional<Imf::Chromaticities> primaries = {},
                const std::string& basis = "", const std::string& mapping = "") {
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) {
    Imf::Header& header =
        headers.emplace_back(windows.display, windows.data, windows.pixelAspectRatio);
    header.setType(Imf::SCANLINEIMAGE);
    if (!part.name.empty()) header.setName(part.name);
    if (primaries) header.insert("chromaticities", Imf::ChromaticitiesAttribute(*primaries));
    if (!basis.empty()) header.insert("basis", Imf::StringAttribute(basis));
    if (!mapping.empty()) header.insert(kMappingAttribute, Imf::StringAttribute(mapping));
    for (const auto& [name, value] : part.channels)
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
  for (size_t i = 0; i < parts.size(); ++i) {
    Imf::OutputPart out(file, int(i));
    const size_t width = size_t(windows.data.max.x - windows.data.min.x + 1);
    std::vector<std::vector<float>> rows;  // one for all rows of a channel
    Imf::FrameBuffer buffer;
    for (const auto& [name, value] : parts[i].channels) {
      float* begin = rows.emplace_back(width, value).data() - windows.data.min.x;
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(begin), sizeof(float), 0));
    }
    out.setFrameBuffer(buffer);
    out.writePixels(windows.data.max.y - windows.data.min.y + 1);
  }
}

Part colored(const std::string& name, const Rgb& color, const std::string& layer = "") {
  return {name, {{layer + "R", color.x}, {layer + "G", color.y}, {layer + "B", color.z}}};
}

std::string problemOf(const std::string& path) {
  try {
    readImage(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// Data in its place, black elsewhere, the rest cropped.
TEST(ExrFiles, ImagesAreTheirDisplayWindows) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const Rgb color(0.5f, 2, 1e10f);
  const auto check = [&](const Windows& windows) {
    writeParts(path, {colored("", color)}, windows);
    const int width = windows.display.max.x - windows.display.min.x + 1,
              height = windows.display.max.y - windows.display.min.y + 1;
    for (const Image& image :
         {readImage(path), readPlate(path), loadProbe(path, "lat-long").latLong}) {
      ASSERT_EQ(image.width, width);
      ASSERT_EQ(image.height, height);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const Imath::V2i at = windows.display.min + Imath::V2i(x, y);
          EXPECT_EQ(image.rgb(x, y), windows.data.intersects(at) ? color : Rgb(0)) << x << " " << y;
        }
    }
  };
  check({{{0, 0}, {15, 4}}, {{0, 0}, {15, 7}}});     // lower rows are absent
  check({{{-4, -4}, {19, 11}}, {{0, 0}, {15, 7}}});  // overscan
  check({{{3, -2}, {30, 5}}, {{0, 0}, {15, 7}}});    // some of both
  check({{{100, 50}, {107, 53}}, {{96, 48}, {111, 55}}});
  // Only the data, for users that place it themselves.
  EXPECT_EQ(readImageFile(path).placement->x, 4);
  EXPECT_EQ(colorOfData(readImageFile(path), path).width, 8);
  writeParts(path, {colored("", color)}, {{{100, 0}, {107, 3}}, {{0, 0}, {15, 7}}});
  EXPECT_NE(problemOf(path).find("outside of its display window"), std::string::npos);
  writeParts(path, {colored("", color)}, {{{0, 0}, {7, 3}}, {{0, 0}, {1 << 29, 1 << 29}}});
  EXPECT_NE(problemOf(path).find("exceed the limit"), std::string::npos);
}

TEST(ExrFiles, TheColourIsChosenByName) {
  const auto layerOf = [](const Names& channels) -> std::string {
    const PartChannels part{"", channels};
    const auto found = findColorChannels({&part, 1});
    return found ? found->channels.front() : "none";
  };
  EXPECT_EQ(layerOf({"B", "G", "R", "beauty.B", "beauty.G", "beauty.R"}), "R");
  EXPECT_EQ(layerOf({"V.AO.B", "V.AO.G", "V.AO.R", "V.Combined.B", "V.Combined.G", "V.Combined.R"}),
            "V.Combined.R");
  EXPECT_EQ(layerOf({"albedo.B", "albedo.G", "albedo.R", "beauty.B", "beauty.G", "beauty.R"}),
            "beauty.R");
  EXPECT_EQ(layerOf({"a.B", "a.G", "a.R", "rgba.A", "rgba.B", "rgba.G", "rgba.R"}), "rgba.R");
  EXPECT_EQ(layerOf({"C.B", "C.G", "C.R", "diffuse.B", "diffuse.G", "diffuse.R"}), "C.R");
  EXPECT_EQ(layerOf({"beauty_main.B", "beauty_main.G", "beauty_main.R", "a.B", "a.G", "a.R"}),
            "beauty_main.R");
  EXPECT_EQ(layerOf({"depth.Z", "diffuse.B", "diffuse.G", "diffuse.R"}), "diffuse.R");
  EXPECT_EQ(layerOf({"A", "Y"}), "Y");
  EXPECT_EQ(layerOf({"Y", "Z"}), "Y");
  EXPECT_EQ(layerOf({"luminance"}), "luminance");
  for (const Names& none :
       {Names{"Z"}, Names{"A"}, Names{"A", "Z"}, Names{"R"}, Names{"G", "R"}, Names{"AO"},
        Names{"AO.B", "AO.G", "AO.R"}, Names{"BY", "RY", "Y", "id"}, Names{"X", "Y", "Z"},
        Names{"N.X", "N.Y", "N.Z"}, Names{"depth.Z"}, Names{"a.R", "b.G", "c.B"}})
    EXPECT_EQ(layerOf(none), "none") << none.front();
}

// In a time that does not grow with the square of their number.
TEST(ExrFiles, ColourIsFoundAmongManyChannels) {
  PartChannels part{"", {}};
  for (int i = 0; i < 300'000; ++i) part.channels.push_back(fmt::format("c{:06}.R", i));
  EXPECT_FALSE(findColorChannels({&part, 1}));
}

// Recognises words in the names that renderers give to their layers, anywhere in them.
TEST(ExrFiles, LayersWithoutLightAreNeverLight) {
  const auto isColor = [](const Names& channels) {
    const PartChannels part{"", channels};
    return findColorChannels({&part, 1}).has_value();
  };
  const auto ofLayer = [](const std::string& layer) {
    return Names{layer + ".B", layer + ".G", layer + ".R"};
  };
  for (const char* layer : {"ViewLayer.Denoising Albedo",
                            "View Layer.Denoising Variance",
                            "View Layer.Denoising Image Variance",
                            "ViewLayer.Denoising Shadowing",
                            "beauty_variance",
                            "RGB_var",
                            "beauty_stddev",
                            "mse",
                            "samplecount",
                            "weights",
                            "heat",
                            "ViewLayer.CryptoObject00",
                            "crypto_material01",
                            "DiffCol",
                            "diffuse_albedo",
                            "View.Position",
                            "bent_normal",
                            "shadow.lamp",
                            "VRayZDepth",
                            "ObjectID",
                            "ID mask",
                            "UVMap",
                            "lineardepth",
                            "motionvector",
                            "Shadow Catcher",
                            "denoise.albedo",
                            "invalid",
                            "View.N",
                            "BaseColor",
                            "base_color",
                            "VRayDiffuseFilter",
                            "VRayWireColor",
                            "diffuse_color",
                            "Pworld",
                            "Nn",
                            "ST",
                            "facing_ratio",
                            "View.Specular Color",
                            "Pref"})
    EXPECT_FALSE(isColor(ofLayer(layer))) << layer;
  for (const char* channel :
       {"depth.Y", "ViewLayer.Depth.V", "distance", "object id", "ZBack", "mask", "clipped", "N.X",
        "ViewLayer.Mist.Z", "Debug Sample Count", "samples", "View.IndexOB.X", "denoise_error.Y"})
    EXPECT_FALSE(isColor({channel})) << channel;
  for (const char* layer :
       {"diffuse", "View.DiffDir", "light.key", "A.Emit", "Depth.Combined", "noisy",
        "View Layer.Noisy Image", "heat lamp", "noise_free", "left", "color", "light_color",
        "no_fog", "emission_color", "P3.spec", "panorama", "image", "candid"})
    EXPECT_TRUE(isColor(ofLayer(layer))) << layer;
  for (const char* channel : {"luminance", "light.Y", "grey", "L", "Y"})
    EXPECT_TRUE(isColor({channel})) << channel;
}

// For a mask, the channel of that name is the right one.
TEST(ExrFiles, MasksAreNoLight) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  for (const char* name : {"mask", "A", "matte.Z"}) {
    writeParts(path, {{"", {{name, 0.25f}}}});
    EXPECT_NE(problemOf(path).find(std::string("it has ") + name), std::string::npos)
        << problemOf(path);
    EXPECT_EQ(maskOf(readImageFile(path), path).rgb(7, 3), Rgb(0.25f));
  }
  writeParts(path, {colored("", Rgb(1, 2, 3))});
  EXPECT_EQ(maskOf(readImageFile(path), path).rgb(7, 3), Rgb(1, 2, 3));
}

// Writes 8 x 4 texels; chroma (0: grey) has half the resolution (ImfRgba.h).
void writeLuminanceChroma(const std::string& path, Imf::PixelType type, float luminance) {
  Imf::Header header(8, 4);
  header.channels().insert("Y", Imf::Channel(type));
  for (const char* chroma : {"RY", "BY"})
    header.channels().insert(chroma, Imf::Channel(type, 2, 2));
  std::vector<float> y(32, luminance), chroma(8, 0);
  std::vector<half> halves(32, luminance), none(8, half(0));
  const bool isHalf = type == Imf::HALF;
  const size_t number = isHalf ? sizeof(half) : sizeof(float);
  Imf::FrameBuffer buffer;
  const auto add = [&](const char* name, void* texels, size_t width, int sampling) {
    buffer.insert(name, Imf::Slice(type, static_cast<char*>(texels), number, number * width,
                                   sampling, sampling));
  };
  add("Y", isHalf ? static_cast<void*>(halves.data()) : y.data(), 8, 1);
  for (const char* name : {"RY", "BY"})
    add(name, isHalf ? static_cast<void*>(none.data()) : chroma.data(), 4, 2);
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(4);
}

// OpenEXR converts luminance and chroma as 16 bits, in which 1e6 is infinite.
TEST(ExrFiles, LuminanceAndChromaAreOf16Bits) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  writeLuminanceChroma(path, Imf::HALF, 2);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(readImage(path).rgb(5, 2)[c], 2, 0.01);
  writeLuminanceChroma(path, Imf::FLOAT, 1e6f);
  EXPECT_NE(problemOf(path).find("are read of 16 bits only"), std::string::npos) << problemOf(path);
}

TEST(ExrFiles, TheColourIsChosenAmongParts) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const Rgb light(0.8f, 0.5f, 0.2f), other(0.1f, 0.9f, 0.4f);
  const auto check = [&](const std::vector<Part>& parts, bool hasNote) {
    writeParts(path, parts);
    const ImageFile file = readImageFile(path);
    EXPECT_EQ(file.messages.size(), hasNote ? 1u : 0u);
    EXPECT_EQ(readImage(path).rgb(2, 1), light) << parts.back().name;
    EXPECT_EQ(loadProbe(path, "lat-long").messages.size(), file.messages.size());
  };
  check({{"depth", {{"Z", 7}}}, colored("any", light)}, false);
  check({colored("albedo", other), colored("beauty", light)}, false);  // an albedo is no light
  check({colored("diffuse", other), colored("View.Combined", light)}, true);
  check({colored("a", other, "AO."), colored("b", light, "Combined.")}, false);
  check({colored("left", light), colored("right", other)}, true);
  writeParts(path, {colored("albedo", other), {"depth", {{"Z", 7}}}});
  EXPECT_NE(problemOf(path).find("has no colour"), std::string::npos);
  EXPECT_NE(problemOf(path).find("R, G, B"), std::string::npos) << problemOf(path);
}

TEST(ExrFiles, PrimariesAreConverted) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  using V = Imath::V2f;
  // ACEScg's matrix, as ACES publishes it for Bradford's adaptation.
  const Imf::Chromaticities acescg(V(0.713f, 0.293f), V(0.165f, 0.83f), V(0.128f, 0.044f),
                                   V(0.32168f, 0.33767f));
  const glm::dmat3 expected(1.70505, -0.13026, -0.02400, -0.62179, 1.14080, -0.12897, -0.08326,
                            -0.01055, 1.15297);
  for (int c = 0; c < 3; ++c) {
    Rgb primary(0);
    primary[c] = 1;
    writeParts(path, {colored("", primary)}, {}, acescg);
    const Rgb read = readImage(path).rgb(0, 0);
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(read[r], expected[c][r], 2e-4);
  }
  // Whites stay white; a beauty layer and a part are converted too.
  for (const Part& white : {colored("", Rgb(1)), colored("", Rgb(1), "beauty.")}) {
    writeParts(path, {white}, {}, acescg);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(readImage(path).rgb(0, 0)[c], 1, 1e-5);
  }
  // CIE XYZ measures light and has no white to adapt to: D65 white is (0.9505, 1, 1.089).
  writeParts(path, {colored("", Rgb(0.95046f, 1, 1.08906f))}, {},
             Imf::Chromaticities(V(1, 0), V(0, 1), V(0, 0), V(1 / 3.f, 1 / 3.f)));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(readImage(path).rgb(0, 0)[c], 1, 1e-3);
  // Rec. 709 keeps every bit.
  writeParts(path, {colored("", Rgb(0.1f, 1e10f, 1e-8f))}, {}, Imf::Chromaticities());
  EXPECT_EQ(readImage(path).rgb(0, 0), Rgb(0.1f, 1e10f, 1e-8f));
}

// Of what has none, such as luminance alone, the texels stay, and nothing is said.
TEST(ExrFiles, PrimariesAreThoseOfThreeChannels) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  using V = Imath::V2f;
  const Imf::Chromaticities ap0(V(0.7347f, 0.2653f), V(0, 1), V(0.0001f, -0.077f),
                                V(0.32168f, 0.33767f));
  const auto messages = [&](const Part& part) {
    writeParts(path, {part}, {}, ap0);
    return readImageFile(path).messages.size();
  };
  Part grey{"", {{"Y", 0.5f}}};
  EXPECT_EQ(messages(grey), 0u);
  EXPECT_EQ(readImage(path).rgb(0, 0), Rgb(0.5f));
  EXPECT_EQ(messages({"", {{"Y", 0.5f}, {"N.R", 0}, {"N.G", 0}, {"N.B", 0}}}), 0u) << "normals";
  EXPECT_EQ(messages({"", {{"Y", 1}, {"albedo.R", 1}, {"albedo.G", 1}, {"albedo.B", 1}}}), 1u);
  EXPECT_EQ(messages(colored("", Rgb(1))), 1u);
}

// As OpenEXR converts them to floats.
TEST(ExrFiles, IntegersKeepTheirNumbers) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const std::vector<uint32_t> numbers = {0, 1, 5, 1 << 20, 4294967295u, 7, 8, 9};
  Imf::Header header(4, 2);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.channels().insert("node", Imf::Channel(Imf::UINT));
  std::vector<float> grey(8, 0.25f);
  Imf::FrameBuffer buffer;
  buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(grey.data()), 4, 16));
  buffer.insert(
      "node", Imf::Slice(Imf::UINT,
                         const_cast<char*>(reinterpret_cast<const char*>(numbers.data())), 4, 16));
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(2);
  }
  const ImageFile file = readImageFile(path);
  EXPECT_EQ(findLayer(file, "node")->texels, std::vector<float>(numbers.begin(), numbers.end()));
  EXPECT_EQ(findColor(file)->rgb(3, 1), Rgb(0.25f));
}

TEST(ExrFiles, DegeneratePrimariesAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  using V = Imath::V2f;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Imf::Chromaticities& primaries :
       {Imf::Chromaticities(V(0, 0), V(0, 0), V(0, 0), V(0, 0)),
        Imf::Chromaticities(V(0.3f, 0.3f), V(0.4f, 0.4f), V(0.5f, 0.5f), V(0.3f, 0.3f)),
        Imf::Chromaticities(V(0.64f, 0.33f), V(0.3f, 0.6f), V(0.15f, 0.06f), V(0.3f, 0)),
        Imf::Chromaticities(V(0.64f, 0.33f), V(0.3f, 0.6f), V(0.15f, 0.06f), V(0.9f, 0.9f)),
        Imf::Chromaticities(V(nan, 0.33f), V(0.3f, 0.6f), V(0.15f, 0.06f), V(0.3f, 0.3f))}) {
    writeParts(path, {colored("", Rgb(1))}, {}, primaries);
    EXPECT_NE(problemOf(path).find("primaries are degenerate"), std::string::npos)
        << problemOf(path);
  }
}

const Imf::Chromaticities kAcesCg(Imath::V2f(0.713f, 0.293f), Imath::V2f(0.165f, 0.83f),
                                  Imath::V2f(0.128f, 0.044f), Imath::V2f(0.32168f, 0.33767f));

// `color` of ACEScg in Rec. 709, as readImage() converts it.
Rgb fromAcesCg(const TemporaryFolder& folder, const Rgb& color) {
  writeParts(folder / "converted.exr", {colored("", color)}, {}, kAcesCg);
  return readImage(folder / "converted.exr").rgb(0, 0);
}

void expectRgb(const Rgb& read, const Rgb& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(read[c], expected[c], 1e-5f * maxComponent(expected));
}

TEST(ExrFiles, LayersOfColourAreConvertedAndDataAreNot) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const Rgb color(0.1f, 0.8f, 0.2f), converted = fromAcesCg(folder, color);
  for (const char* name : {"light.sun", "albedo", "difference", "denoise.albedo", "BaseColor"}) {
    writeParts(path, {colored("", color, std::string(name) + ".")}, {}, kAcesCg);
    expectRgb(findLayer(readImageFile(path), name)->rgb(0, 0), converted);
    EXPECT_EQ(layerOf(readImageFile(path), name, path)->rgb(0, 0),
              findLayer(readImageFile(path), name)->rgb(0, 0));
  }
  for (const char* name :
       {"normal", "bent_normal", "variance", "Pworld", "mask", "crypto00", "N"}) {
    writeParts(path, {colored("", color, std::string(name) + ".")}, {}, kAcesCg);
    EXPECT_EQ(findLayer(readImageFile(path), name)->rgb(0, 0), color) << name;
  }
  writeParts(path, {{"", {{"a.X", 0.1f}, {"a.Y", 0.8f}, {"a.Z", 0.2f}}}}, {}, kAcesCg);
  EXPECT_EQ(findLayer(readImageFile(path), "a")->rgb(0, 0), color);
}

// Saturation, white and black refer to the sensor's channels: in Rec. 709 the red of this colour is
// negative.
TEST(ExrFiles, PhotographsAreMergedInTheirPrimaries) {
  const TemporaryFolder folder;
  const Rgb color(0.1f, 0.8f, 0.2f), converted = fromAcesCg(folder, color);
  ASSERT_LT(converted.x, 0);
  PhotographSeries series;
  series.times = {1, 0.25, 0.0625};
  series.checkAlignment = false;
  for (size_t i = 0; i < series.times.size(); ++i) {
    series.files.push_back(folder / fmt::format("{}.exr", i));
    writeParts(series.files[i], {colored("", color * float(series.times[i]))}, {}, kAcesCg);
  }
  MergedPhotographs merged = mergePhotographs(series);
  expectRgb(merged.image.radiance.rgb(3, 2), converted);
  EXPECT_EQ(merged.white, 1);
  EXPECT_EQ(merged.image.underexposedPixels, 0u);
  // A flat field is one of the same channels.
  const Rgb flat(0.5f, 0.9f, 0.7f);
  writeParts(folder / "flat.exr", {colored("", flat)}, {}, kAcesCg);
  series.flatFields = {{{}, folder / "flat.exr"}};
  merged = mergePhotographs(series);
  expectRgb(merged.image.radiance.rgb(3, 2), fromAcesCg(folder, color / flat));
  // One in Rec. 709 is converted to them.
  writeParts(folder / "flat.exr", {colored("", fromAcesCg(folder, flat))});
  merged = mergePhotographs(series);
  expectRgb(merged.image.radiance.rgb(3, 2), fromAcesCg(folder, color / flat));

  writeParts(series.files[1], {colored("", color * 0.25f)});
  try {
    mergePhotographs(series);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1.exr: its primaries are not those of"),
              std::string::npos)
        << error.what();
  }
}

TEST(ExrFiles, LightStagesAreConvertedOrRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const Rgb color(0.1f, 0.8f, 0.2f), converted = fromAcesCg(folder, color);
  // One element: the function sh:0, the constant.
  const auto write = [&](const Windows& windows, std::optional<Imf::Chromaticities> primaries) {
    Part part = colored("", color);
    for (const char* layer : {"element.0000.", "own."})
      for (const auto& channel : colored("", color, layer).channels)
        part.channels.push_back(channel);
    writeParts(path, {part}, windows, primaries, "sh:0");
  };
  write({}, {});
  EXPECT_EQ(StageReader(path).read(1, 2).elements.rgb(0, 0), color);
  EXPECT_TRUE(StageReader(path).messages().empty());
  write({}, kAcesCg);
  StageReader wide(path);
  const LightStage stage = wide.read(1, 2);
  ASSERT_EQ(wide.messages().size(), 1u);
  EXPECT_TRUE(wide.messages()[0].text.starts_with(
      path + ": its colour is converted to Rec. 709 from red (0.713, 0.293)"));
  expectRgb(stage.elements.rgb(7, 1), converted);
  expectRgb(stage.own.rgb(7, 1), converted);
  write({{{2, 0}, {7, 3}}, {{0, 0}, {7, 3}}}, {});
  try {
    StageReader reader(path);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("data window"), std::string::npos) << error.what();
  }
}

// A fisheye is square: its display window is, whatever part of it has data.
TEST(ExrFiles, TheMappingIsOfTheDisplayWindow) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  writeParts(path, {colored("", Rgb(1))}, {{{0, 2}, {7, 5}}, {{0, 0}, {7, 7}}}, {}, "",
             "fisheye:180:equisolid");
  EXPECT_EQ(mappingName(loadProbe(path).mapping), "fisheye:180:equisolid");
}

TEST(ExrFiles, PixelsThatAreNotSquareAreNamed) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  Windows windows;
  writeParts(path, {colored("", Rgb(1))}, windows);
  EXPECT_TRUE(readImageFile(path).messages.empty());
  windows.pixelAspectRatio = 2;
  writeParts(path, {colored("", Rgb(1))}, windows);
  const Messages messages = readImageFile(path).messages;
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].kind, Message::Kind::Warning);
  EXPECT_NE(messages[0].text.find("pixels are not square, 2 times"), std::string::npos);
}

}  // namespace
}  // namespace chromeball::exr_files_test
