// SPDX-License-Identifier: Apache-2.0
// chromeball render --display tev: sends a render while it grows to the image viewer tev.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "session/viewer.h"

namespace chromeball {

class TevDisplay : public Viewer {
 public:
  // `address`: "HOST:PORT". Throws InputError if no program accepts connections there.
  explicit TevDisplay(const std::string& address);
  // Sends what has been shown, for some seconds at most.
  ~TevDisplay() override;

  void begin(const std::string& name) override { name_ = name; }
  void update(double) override {}
  bool wantsImage() const override { return isIdle_; }  // if the last is sent
  void show(std::shared_ptr<const ImageSoFar> image) override;

 private:
  struct Sent {
    std::string name;
    std::vector<std::string> channels;
    bool operator==(const Sent&) const = default;
  };
  void run();
  void sendImages(std::unique_lock<std::mutex>& lock);
  bool send(const std::string& name, const OutputImage& image);
  bool send(const std::vector<char>& packet);

  int socket_ = -1;
  std::string name_;
  Sent last_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const ImageSoFar> waiting_;  // to be sent, under waitingName_
  std::string waitingName_;
  bool ends_ = false, hasEnded_ = false;  // asked to end; the sender has
  std::atomic<bool> isIdle_ = true;
  std::thread sender_;
};

}  // namespace chromeball
