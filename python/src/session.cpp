// SPDX-License-Identifier: Apache-2.0
// Renders in the background, from Python's threads.
#include "session/session.h"

#include <nanobind/stl/optional.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "bindings.h"
#include "messages.h"
#include "plan.h"
#include "process.h"
#include "result.h"
#include "values.h"

namespace chromeball::python {
namespace {

using namespace std::chrono_literals;

class PythonSession {
 public:
  PythonSession(const Plan& plan, nb::object progress)
      : progress_(std::move(progress)),
        strategy_(plan.strategy),
        output_(plan.description.output),
        threads_(plan.threads) {
    session_.emplace(plan.description,
                     SessionCallbacks{[this](const SessionProgress& p) { report(p); },
                                      {},
                                      [this] { finish(); },
                                      keywordInWords});
    const nb::gil_scoped_release released;
    const std::lock_guard lock(living().mutex);
    living().sessions.insert(this);
  }
  // The session's thread may be waiting for the interpreter.
  ~PythonSession() {
    const nb::gil_scoped_release released;
    {
      const std::lock_guard lock(living().mutex);
      living().sessions.erase(this);
    }
    session_.reset();
    limit_.reset();
  }
  PythonSession(const PythonSession&) = delete;

  void start() {
    checkProcess();
    const nb::gil_scoped_release released;
    const std::lock_guard lock(calls_);
    if (std::exchange(isStarted_, true)) return;
    {
      const std::lock_guard finishing(finishing_);
      isFinished_ = false;
    }
    limit_.emplace(threads_);
    session_->start();
  }
  // Python's signals are handled meanwhile: Ctrl-C ends the render.
  Result wait() {
    while (!finishesWithin(20ms))
      if (PyErr_CheckSignals() != 0) {
        nb::python_error interrupt;
        requestCancel();
        while (!finishesWithin(1s)) {
        }
        throw interrupt;
      }
    const nb::gil_scoped_release released;
    const std::lock_guard lock(calls_);
    if (!isStarted_) throwRun("the session has not been started");
    session_->wait();
    limit_.reset();
    return resultOf(session_->snapshot());
  }
  std::optional<Result> snapshot() {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(calls_);
    if (!isStarted_) return {};
    auto image = session_->snapshot();
    if (!image) return {};
    return resultOf(std::move(image));
  }
  void update(const Plan& plan) {
    {
      const nb::gil_scoped_release released;
      const std::lock_guard lock(calls_);
      session_->update(plan.description);
      output_ = plan.description.output;
      threads_ = plan.threads;
      isStarted_ = false;
      limit_.reset();
    }
    strategy_ = plan.strategy;
  }
  void requestCancel() { session_->requestCancel(); }
  void cancel() {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(calls_);
    session_->cancel();
    limit_.reset();
  }
  bool isRunning() const { return session_->isRunning(); }
  double fraction() const { return session_->fraction(); }
  Session::Work work() {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(calls_);
    return session_->work();
  }

  nb::object& progress() { return progress_; }
  const nb::object& strategy() const { return strategy_; }
  // For the garbage collector: the session is not used any more.
  void clear() {
    cancel();
    progress_ = nb::none();
    strategy_.reset();
  }

  // Before the interpreter ends, whose end the sessions' threads could not call back into.
  static void cancelAll() {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(living().mutex);
    for (PythonSession* session : living().sessions) session->requestCancel();
    for (PythonSession* session : living().sessions) {
      const std::lock_guard own(session->calls_);
      session->session_->cancel();
    }
  }

 private:
  struct Living {
    std::mutex mutex;
    std::set<PythonSession*> sessions;
  };
  static Living& living() {
    static Living all;
    return all;
  }

  void report(const SessionProgress& p) {
    const nb::gil_scoped_acquire acquired;
    if (acquired.is_valid() && progress_.is_valid() && !progress_.is_none())
      progress_(p.stage, p.fraction);
  }
  void finish() {
    const std::lock_guard lock(finishing_);
    isFinished_ = true;
    finished_.notify_all();
  }
  // At once for a session that is not started.
  bool finishesWithin(std::chrono::milliseconds time) {
    const nb::gil_scoped_release released;
    std::unique_lock lock(finishing_);
    return finished_.wait_for(lock, time, [&] { return isFinished_; });
  }
  Result resultOf(std::shared_ptr<const SessionImage> image) const {
    Messages messages;
    if (!session_->isRunning()) messages = session_->messages();
    messages.insert(messages.end(), image->messages.begin(), image->messages.end());
    return {std::move(image), output_, std::move(messages)};
  }

  nb::object progress_;
  nb::object strategy_;  // which the render calls
  OutputDescription output_;
  size_t threads_;
  std::optional<ThreadLimit> limit_;
  bool isStarted_ = false;
  std::mutex calls_;  // a Session is for one thread at a time
  std::mutex finishing_;
  std::condition_variable finished_;
  bool isFinished_ = true;
  std::optional<Session> session_;
};

// A function that reports progress and a strategy may refer to their session.
int traverse(PyObject* self, visitproc visit, void* arg) {
#if PY_VERSION_HEX >= 0x03090000
  Py_VISIT(Py_TYPE(self));
#endif
  if (!nb::inst_ready(self)) return 0;
  auto* session = nb::inst_ptr<PythonSession>(self);
  Py_VISIT(session->progress().ptr());
  Py_VISIT(session->strategy().ptr());
  return 0;
}
int clear(PyObject* self) {
  nb::inst_ptr<PythonSession>(self)->clear();
  return 0;
}
PyType_Slot kSlots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse)},
                        {Py_tp_clear, reinterpret_cast<void*>(clear)},
                        {0, nullptr}};

}  // namespace

void bindSession(nb::module_& m) {
  nb::class_<PythonSession>(m, "Session", nb::type_slots(kSlots), "A render in the background.")
      .def(nb::init<const Plan&, nb::object>(), nb::arg("plan"), nb::arg("progress").none())
      .def("start", &PythonSession::start)
      .def("wait", &PythonSession::wait)
      .def("snapshot", &PythonSession::snapshot)
      .def("update", &PythonSession::update, nb::arg("plan"))
      .def("cancel", &PythonSession::cancel)
      .def("request_cancel", &PythonSession::requestCancel)
      .def_prop_ro("is_running", &PythonSession::isRunning)
      .def_prop_ro("fraction", &PythonSession::fraction)
      .def_prop_rw(
          "progress", [](PythonSession& s) { return s.progress(); },
          [](PythonSession& s, nb::object f) { s.progress() = std::move(f); }, nb::arg().none())
      .def_prop_ro("work", [](PythonSession& s) {
        const Session::Work work = s.work();
        Dict all;
        all["loaded_scene"] = work.loadedScene;
        all["loaded_probe"] = work.loadedProbe;
        all["prepared_lighting"] = work.preparedLighting;
        all["mesh_builds"] = work.meshBuilds;
        return all;
      });
  m.def("cancel_all", PythonSession::cancelAll, "Ends all sessions.");
}

}  // namespace chromeball::python
