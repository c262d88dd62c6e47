// SPDX-License-Identifier: Apache-2.0
// Names and values of hostile files, as messages echo them.
#include "base/text.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "base/message.h"
#include "run_command.h"

namespace chromeball::printable_test {
namespace {

TEST(Printable, PlainTextStaysAsItIs) {
  for (const char* text : {"", "a b  c", "scene.toml:3: `größe` – 東京 😀", "  two spaces "})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ControlCharactersAndEscapesAreRemoved) {
  EXPECT_EQ(printable("a\nb\tc\rd"), "a b c d");
  EXPECT_EQ(printable(std::string_view("a\0b\x7f", 4)), "a?b?");
  EXPECT_EQ(printable("\x1b[31mred\x1b[0m"), "red");
  EXPECT_EQ(printable("\x1b]0;title\arest"), "rest");
  EXPECT_EQ(printable("end\x1b"), "end?");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "??31m");  // U+009B begins escape sequences too
}

// A name must not look like another, such as gpj.exr for exr.jpg.
TEST(Printable, DirectionsOfTextAreRemoved) {
  for (const char* control : {"\u061c", "\u200e", "\u200f", "\u2028", "\u2029", "\u202a", "\u202b",
                              "\u202c", "\u202d", "\u202e", "\u2066", "\u2067", "\u2068", "\u2069"})
    EXPECT_EQ(printable(std::string("a") + control + "b"), "a?b");
  for (const char* text : {"שלום", "مرحبا", "\u2010", "\u2027", "\u2030", "\u2065", "\u206a"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, MalformedUtf8IsReplaced) {
  EXPECT_EQ(printable("\xff\xfe"), "??");
  EXPECT_EQ(printable("\xc0\xaf"), "??");            // too long for its number
  EXPECT_EQ(printable("\xed\xa0\x80"), "???");       // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????");  // beyond U+10FFFF
  EXPECT_EQ(printable("\xe6\x9d"), "??");            // cut off
}

TEST(Printable, LongWordsAndLinesAreShortened) {
  const std::string word = printable("model " + std::string(100000, 'a') + " is unknown");
  EXPECT_EQ(word.size(), 6 + 200 + 11);
  EXPECT_TRUE(word.starts_with("model aaa"));
  EXPECT_TRUE(word.ends_with("aaa is unknown"));
  std::string many;
  for (int i = 0; i < 30000; ++i) many += "ab ";
  EXPECT_LE(printable(many).size(), 2000);
  std::string wide;
  for (int i = 0; i < 1000; ++i) wide += "é";
  const std::string cut = printable(wide);
  EXPECT_LE(cut.size(), 200);
  EXPECT_EQ(cut.find('?'), std::string::npos);
  EXPECT_EQ(printable(cut), cut);
}

TEST(Printable, NamesAndListsOfNames) {
  std::string spaces;
  for (int i = 0; i < 1000; ++i) spaces += "a ";
  EXPECT_EQ(printableName(spaces).size(), 200u);
  EXPECT_EQ(printableName("a\nb"), "a b");
  EXPECT_EQ(firstNames({}), "");
  EXPECT_EQ(firstNames({"a", "b\x1b"}), "a, b?");
  EXPECT_EQ(firstNames(std::vector<std::string>(8, "a")), "a, a, a, a, a, a and 2 more");
}

// Messages of a kind differ in numbers and quoted names.
TEST(Condensed, ManyOfAKindAreCounted) {
  Messages messages;
  const auto add = [&](Message::Kind kind, const std::string& text) {
    messages.push_back({kind, text});
  };
  for (int i = 0; i < 5000; ++i) {
    add(Message::Kind::Warning, fmt::format("m[{}].factor: {} is clamped to 1", i, -1.5e-7 * i));
    add(Message::Kind::Note, fmt::format("camera \"{}\" is ignored", std::string(i % 9, 'a')));
    if (i < 3) add(Message::Kind::Note, fmt::format("picture {} is dark", i));
  }
  const Messages few = condensed(messages);
  ASSERT_EQ(few.size(), 5u);
  EXPECT_EQ(few[0].text, "m[0].factor: -0 is clamped to 1 (and 4999 more of this kind)");
  EXPECT_EQ(few[1].text, "camera \"\" is ignored (and 4999 more of this kind)");
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(few[size_t(2 + i)].text, fmt::format("picture {} is dark", i));
  EXPECT_EQ(condensed(few).size(), few.size());
}

// Whatever the bytes, the result is printable text that is not changed again.
TEST(Printable, OfAnyBytes) {
  std::mt19937 random(11);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes(random() % 700, ' ');
    for (char& c : bytes) c = char(random());
    const std::string text = printable(bytes);
    EXPECT_EQ(printable(text), text);
    for (const char c : text) EXPECT_GE(uint8_t(c), uint8_t(' '));
  }
}

class SlowHostileMessage : public testing::Test {
 protected:
  const TemporaryFolder folder;

  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
    return folder / name;
  }

  // One short line and status 2, which begin with `what`.
  void expectRefusal(const std::vector<std::string>& arguments, const std::string& what) const {
    const CommandResult result = runCommand(arguments);
    EXPECT_EQ(result.status, 2) << what;
    EXPECT_LE(result.error.size(), 700) << what;
    EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
    EXPECT_NE(result.error.find(what), std::string::npos) << result.error;
  }
};

TEST_F(SlowHostileMessage, DeepKeys) {
  std::string key = "a";
  for (int i = 0; i < 200000; ++i) key += ".a";
  expectRefusal({"render", file("header.toml", "[" + key + "]\nb=1\n")},
                "header.toml:1: a key has more than 16 parts");
  expectRefusal({"render", file("key.toml", "# a.b\n\"c.d\" = '...'\n" + key + " = 1\n")},
                "key.toml:3: a key has more than 16 parts");
  expectRefusal({"render", file("table.toml", "a = {" + key + " = 1}\n")},
                "table.toml:1: a key has more than 16 parts");
  // Dots that are not of keys.
  std::string numbers =
      "x = \"................................\" # ..............................\n"
      "y = '''\n....................\n''' \nz = [";
  for (int i = 0; i < 50; ++i) numbers += "0.5, ";
  expectRefusal({"render", file("dots.toml", numbers + "1.5]\n")}, "unknown key `x`");
}

TEST_F(SlowHostileMessage, NumbersBeyondADouble) {
  for (const std::string& number : {std::string("1e999"), std::string(100000, '9')}) {
    const std::string lights = file("lights.json", R"({"lights":[{"direction":[)" + number +
                                                       R"(,0,1],"irradiance":[1,1,1]}]})");
    const std::string polygons =
        file("polygons.json", R"({"polygons":[{"probe_polygon":[[)" + number + R"(,1]]}]})");
    ASSERT_EQ(runCommand({"probe", "synth", "constant", folder / "p.exr"}).status, 0);
    expectRefusal({"probe", "add-sun", folder / "p.exr", folder / "o.exr", "--lights", lights},
                  "lights.json: has a number beyond");
    expectRefusal({"lights", folder / "p.exr", "--polygons", polygons, "-o", folder / "l.json"},
                  "polygons.json: has a number beyond");
  }
}

TEST_F(SlowHostileMessage, LongAndLoopingPaths) {
  const std::string name(100000, 'n');
  expectRefusal({"render", name + ".gltf", "-o", folder / "o.exr"}, "too long");
  const std::string scene = file("long.toml", "model = \"" + name + "\"\n");
  expectRefusal({"render", scene, "-o", folder / "o.exr"}, "too long");
  expectRefusal({"probe", "info", folder / std::string(300, 'n')}, "too long");
  std::filesystem::create_symlink("loop.exr", folder / "loop.exr");
  expectRefusal({"probe", "info", folder / "loop.exr"}, "symbolic links");
  expectRefusal({"image", "view", folder / "loop.exr", folder / "o.png"},
                "loop.exr: Too many levels");
  ASSERT_EQ(runCommand({"probe", "synth", "constant", folder / "p.exr"}).status, 0);
  expectRefusal(
      {"probe", "convert", folder / "p.exr", folder / "loop.exr/x/o.exr", "--to", "angular"},
      "symbolic links");
}

TEST_F(SlowHostileMessage, ManyWarningsOfAKind) {
  std::string materials, primitives;
  for (int i = 0; i < 5000; ++i) {
    materials += fmt::format(R"({}{{"pbrMetallicRoughness":{{"roughnessFactor":{}}}}})",
                             i ? "," : "", 2 + i);
    primitives +=
        fmt::format(R"({}{{"attributes":{{"POSITION":0}},"material":{}}})", i ? "," : "", i);
  }
  const std::string model =
      file("m.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"materials":[)" +
                         materials + R"(],"meshes":[{"primitives":[)" + primitives +
                         R"(]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,)"
                         R"("type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
                         R"("buffers":[{"byteLength":36,"uri":"data:;base64,)"
                         R"(AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]})");
  ASSERT_EQ(runCommand({"probe", "synth", "constant", folder / "p.exr"}).status, 0);
  const CommandResult result =
      runCommand({"render", model, "--probe", folder / "p.exr", "-o", folder / "o.exr", "--size",
                  "4x4", "--samples", "1", "--quiet"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("roughnessFactor: 2 is clamped to the range 0 to 1 (and 4999 more of "
                              "this kind)\n"),
            std::string::npos)
      << result.error.substr(0, 2000);
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1);
}

TEST_F(SlowHostileMessage, ScalesOfPfm) {
  for (const char* scale : {"nan", "0", "-0.0", "inf", "-nan", "1e999"})
    expectRefusal({"probe", "info",
                   file("p.pfm", "PF\n2 1\n" + std::string(scale) + "\n" + std::string(24, '\0'))},
                  "p.pfm: ");
}

}  // namespace
}  // namespace chromeball::printable_test
