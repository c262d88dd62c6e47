// SPDX-License-Identifier: Apache-2.0
// chromeball render --display tev, with a receiver that decodes the packets by the description of
// the protocol (viewers/tev_display.cpp).
#include <gtest/gtest.h>

#include <cstring>
#include <future>
#include <map>

#include "image/io/write_image.h"
#include "run_command.h"
#include "small_model.h"
#include "tcp.h"

namespace chromeball::command_tev_test {
namespace {

class Packet {
 public:
  explicit Packet(std::string bytes) : bytes_(std::move(bytes)) {}

  template <class T>
  T take() {
    T value{};
    if (at_ + sizeof value > bytes_.size()) {
      ADD_FAILURE() << "the packet is too short";
      return value;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string takeText() {
    const std::string text = bytes_.c_str() + at_;
    at_ += text.size() + 1;
    return text;
  }
  size_t left() const { return bytes_.size() - at_; }

 private:
  std::string bytes_;
  size_t at_ = 0;
};

struct Channel {
  int width = 0, height = 0;
  std::vector<float> values;
};
using Channels = std::map<std::string, Channel>;

// The images of a viewer, by name.
struct Receiver {
  std::map<std::string, Channels> images;
  int created = 0, closed = 0, updates = 0;

  void create(Packet& packet) {
    ++created;
    packet.take<char>();  // whether to grab the focus
    Channels& channels = images[packet.takeText()];
    EXPECT_TRUE(channels.empty()) << "there is an image of this name";
    const int width = packet.take<int32_t>(), height = packet.take<int32_t>();
    for (int count = packet.take<int32_t>(); count > 0; --count)
      channels[packet.takeText()] = {width, height, std::vector<float>(size_t(width) * height)};
  }

  void update(Packet& packet) {
    ++updates;
    packet.take<char>();
    Channels& channels = images.at(packet.takeText());
    const auto count = size_t(packet.take<int32_t>());
    std::vector<std::string> names(count);
    for (std::string& name : names) name = packet.takeText();
    const int x0 = packet.take<int32_t>(), y0 = packet.take<int32_t>();
    const int width = packet.take<int32_t>(), height = packet.take<int32_t>();
    std::vector<int64_t> offsets(count), strides(count);
    for (int64_t& offset : offsets) offset = packet.take<int64_t>();
    for (int64_t& stride : strides) stride = packet.take<int64_t>();
    std::vector<float> data(packet.left() / sizeof(float));
    for (float& value : data) value = packet.take<float>();
    for (size_t c = 0; c < count; ++c) {
      Channel& channel = channels.at(names[c]);
      ASSERT_TRUE(x0 >= 0 && y0 >= 0 && x0 + width <= channel.width &&
                  y0 + height <= channel.height);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          channel.values[size_t(y0 + y) * channel.width + x0 + x] =
              data.at(size_t(offsets[c] + strides[c] * (y * width + x)));
    }
  }

  // Receives packets until the sender ends, at most `most`.
  void run(const Socket& socket, int most = 1'000'000) {
    for (int i = 0; i < most; ++i) {
      uint32_t length = 0;
      const std::string head = socket.read(sizeof length);
      if (head.size() < sizeof length) return;
      std::memcpy(&length, head.data(), sizeof length);
      Packet packet(socket.read(length - sizeof length));
      ASSERT_EQ(packet.left(), length - sizeof length);
      switch (packet.take<char>()) {
        case 2:
          ++closed;
          images.erase(packet.takeText());
          break;
        case 4:
          create(packet);
          break;
        case 6:
          update(packet);
          break;
        default:
          FAIL() << "an unknown type";
      }
      EXPECT_EQ(packet.left(), 0u);
    }
  }
};

struct TevRender {
  TemporaryFolder folder;
  Listener listener;

  TevRender() {
    writeSmallModel(folder / "m.gltf");
    writeImage(folder / "probe.pfm", [] {
      Image probe(4, 2, 3);
      probe.texels.assign(probe.texels.size(), 1.0f);
      return probe;
    }());
  }
  std::future<CommandResult> start(std::vector<std::string> more,
                                   const std::string& size = "40x30") const {
    std::vector<std::string> words{"render",    folder / "m.gltf",
                                   "--probe",   folder / "probe.pfm",
                                   "--size",    size,
                                   "--display", fmt::format("tev=127.0.0.1:{}", listener.port())};
    words.insert(words.end(), more.begin(), more.end());
    return std::async(std::launch::async, [words] { return runCommand(words); });
  }
};

// At the end the viewer has the same channels as the file.
void expectSameAsFile(const Channels& shown, const std::string& path) {
  const ImageFile file = readImageFile(path);
  for (size_t c = 0; c < file.channels.size(); ++c) {
    SCOPED_TRACE(file.channels[c]);
    const auto channel = shown.find(file.channels[c]);
    ASSERT_NE(channel, shown.end());
    ASSERT_EQ(channel->second.width, file.image.width);
    ASSERT_EQ(channel->second.height, file.image.height);
    for (size_t i = 0; i < channel->second.values.size(); ++i)
      ASSERT_EQ(channel->second.values[i], file.image.texels[i * file.channels.size() + c]) << i;
  }
}

TEST(TevDisplay, ReceivesTheImageWithItsLayers) {
  const TevRender tev;
  const std::string out = tev.folder / "o.exr";
  auto command = tev.start({"--samples", "64", "--aov", "normal,node,variance", "-o", out});
  Receiver receiver;
  receiver.run(tev.listener.accept());
  const CommandResult result = command.get();
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(receiver.created, 1);
  ASSERT_EQ(receiver.images.size(), 1u);
  const auto& [name, channels] = *receiver.images.begin();
  EXPECT_EQ(name, out);
  EXPECT_EQ(channels.size(), 3u + 3 + 1 + 3 + 1);  // the counts of samples are shown as well
  expectSameAsFile(channels, out);
}

TEST(TevDisplay, ReceivesOtherLayersAfterDenoising) {
  const TevRender tev;
  const std::string out = tev.folder / "o.exr";
  auto command = tev.start({"--samples", "64", "--denoise", "-o", out});
  Receiver receiver;
  receiver.run(tev.listener.accept());
  ASSERT_EQ(command.get().status, 0);
  ASSERT_EQ(receiver.images.size(), 1u);
  EXPECT_EQ(receiver.created, receiver.closed + 1);
  expectSameAsFile(receiver.images.begin()->second, out);
}

TEST(TevDisplay, ReceivesEachFrame) {
  const TevRender tev;
  auto command = tev.start(
      {"--samples", "4", "--frames", "0:2", "--orbit", "90", "-o", tev.folder / "f.#.exr"});
  Receiver receiver;
  receiver.run(tev.listener.accept());
  ASSERT_EQ(command.get().status, 0);
  ASSERT_EQ(receiver.images.size(), 3u);
  for (const auto& [name, channels] : receiver.images) expectSameAsFile(channels, name);
}

TEST(SlowTevDisplay, MayEndWhileTheRenderGoesOn) {
  const TevRender tev;
  const std::string out = tev.folder / "o.exr";
  auto command = tev.start({"--time", "1", "-o", out});
  Receiver receiver;
  receiver.run(tev.listener.accept(), 1);
  const CommandResult result = command.get();
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.error.find("warning: tev has ended"), std::string::npos) << result.error;
  EXPECT_TRUE(std::filesystem::exists(out));
}

// An image that does not fit into the buffers of the connection.
TEST(SlowTevDisplay, MayReadNothing) {
  const TevRender tev;
  const std::string out = tev.folder / "o.exr";
  auto command = tev.start({"--samples", "2", "-o", out}, "1600x1200");
  const Socket socket = tev.listener.accept();
  const CommandResult result = command.get();
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.error.find("warning: tev has ended"), std::string::npos) << result.error;
  EXPECT_TRUE(std::filesystem::exists(out));
}

TEST(TevDisplay, IsMissed) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "m.gltf");
  const auto refused = [&](const std::string& display, const std::string& reason) {
    expectError({"render", folder / "m.gltf", "--display", display, "-o", folder / "o.png"},
                reason);
  };
  refused(fmt::format("tev=127.0.0.1:{}", freePort()), "start tev first");
  refused("tev=127.0.0.1", "is not HOST:PORT");
  refused("tev=:80", "is not HOST:PORT");
  refused("tev=127.0.0.1:8x", "is not HOST:PORT");
  refused("tev=127.0.0.1:99999", "is not HOST:PORT");
  refused("lev", "is not tev");
}

}  // namespace
}  // namespace chromeball::command_tev_test
