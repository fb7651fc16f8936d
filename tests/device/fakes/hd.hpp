// A fake of the functions of HDAPI that palpate calls: names and signatures as documented, numbers and behaviour
// written for the tests.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

using HHD = unsigned int;
using HDenum = unsigned int;
using HDerror = unsigned int;
using HDint = int;
using HDdouble = double;
using HDulong = unsigned long;
using HDushort = unsigned short;
using HDstring = const char*;
using HDCallbackCode = unsigned int;
using HDSchedulerHandle = unsigned long;
struct HDErrorInfo {
  HDerror errorCode;
  int internalErrorCode;
  HHD hHD;
};
#define HDCALLBACK
using HDSchedulerCallback = HDCallbackCode(HDCALLBACK*)(void*);

#define HD_SUCCESS 0
#define HD_DEVICE_ERROR(x) ((x).errorCode != HD_SUCCESS)
#define HD_DEFAULT_DEVICE NULL
#define HD_CALLBACK_DONE 0
#define HD_CALLBACK_CONTINUE 1
#define HD_MAX_SCHEDULER_PRIORITY 9999
#define HD_WARM_MOTORS 11
#define HD_EXCEEDED_MAX_FORCE 12
#define HD_EXCEEDED_MAX_FORCE_IMPULSE 13
#define HD_EXCEEDED_MAX_VELOCITY 14
#define HD_FORCE_ERROR 15
#define HD_COMM_ERROR 21
#define HD_DEVICE_FAULT 22
#define HD_CURRENT_POSITION 101
#define HD_CURRENT_VELOCITY 102
#define HD_CURRENT_TRANSFORM 103
#define HD_CURRENT_BUTTONS 104
#define HD_CURRENT_FORCE 105
#define HD_NOMINAL_MAX_FORCE 107
#define HD_NOMINAL_MAX_CONTINUOUS_FORCE 108
#define HD_NOMINAL_MAX_STIFFNESS 109
#define HD_USABLE_WORKSPACE_DIMENSIONS 110
#define HD_FORCE_OUTPUT 201
#ifdef FAKE_HD_OLD  // the older revision of the headers
#define HD_CURRENT_TORQUE 106
#else
#define HD_CURRENT_GIMBAL_TORQUE 106
#endif

namespace fake_hd {

struct Sdk {
  std::vector<std::string> calls;
  std::vector<HDerror> errors;  ///< the newest last
  std::array<double, 3> position{}, velocity{};
  std::array<double, 16> transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  int buttons = 0;
  double max_force = 3.3, continuous = 0.88, stiffness = 0.5;
  std::array<double, 6> workspace{-80, -60, -35, 80, 60, 35};
  std::array<double, 3> frame_force{}, frame_torque{};  ///< set in this frame
  std::array<double, 3> force{}, torque{};              ///< sent to the motors
  bool output = false, in_frame = false, broken = false, init_fails = false, calls_back = true;
  int misuse = 0;  ///< frames begun twice, ended without begin; values read or set outside a frame
  HDSchedulerCallback callback = nullptr;
  void* callback_data = nullptr;
  unsigned long rate = 0;
  std::thread thread;
  std::atomic<bool> stop_thread{false};
  std::atomic<int> errors_asked_elsewhere{0};  ///< from another thread while the scheduler runs
  std::atomic<bool> scheduler_runs{false};
};
inline Sdk*& current() {
  static Sdk* s = nullptr;
  return s;
}
inline Sdk& sdk() {
  return *current();
}
/// A new SDK state for a test.
struct Scope {
  Sdk sdk;
  Scope() { current() = &sdk; }
  ~Scope() { current() = nullptr; }
};
inline void fail(HDerror code) {
  sdk().errors.push_back(code);
}

}  // namespace fake_hd

inline HHD hdInitDevice(HDstring) {
  fake_hd::sdk().calls.push_back("init");
  if (fake_hd::sdk().init_fails) fake_hd::fail(HD_DEVICE_FAULT);
  return 7;
}
inline void hdMakeCurrentDevice(HHD) {}
inline void hdDisableDevice(HHD) {
  fake_hd::sdk().calls.push_back("disable device");
}
inline HDErrorInfo hdGetError() {
  auto& s = fake_hd::sdk();
  if (s.scheduler_runs && std::this_thread::get_id() != s.thread.get_id()) ++s.errors_asked_elsewhere;
  if (s.errors.empty()) return {HD_SUCCESS, 0, 7};
  const HDerror code = s.errors.back();
  s.errors.pop_back();
  return {code, 0, 7};
}
inline HDstring hdGetErrorString(HDerror code) {
  return code == HD_DEVICE_FAULT ? "device fault" : "another error";
}
inline void hdBeginFrame(HHD) {
  auto& s = fake_hd::sdk();
  if (s.in_frame) ++s.misuse;
  s.in_frame = true;
  s.frame_force = s.frame_torque = {};
  s.calls.push_back("begin");
  if (s.broken) fake_hd::fail(HD_COMM_ERROR);
}
inline void hdEndFrame(HHD) {
  auto& s = fake_hd::sdk();
  if (!s.in_frame) ++s.misuse;
  s.in_frame = false;
  s.force = s.output ? s.frame_force : std::array<double, 3>{};
  s.torque = s.output ? s.frame_torque : std::array<double, 3>{};
  s.calls.push_back("end");
}
inline void hdEnable(HDenum) {
  fake_hd::sdk().calls.push_back("enable");
  fake_hd::sdk().output = true;
}
inline void hdDisable(HDenum) {
  auto& s = fake_hd::sdk();
  s.calls.push_back("disable");
  s.output = false;
  s.force = s.torque = {};
}
inline void hdGetDoublev(HDenum what, HDdouble* v) {
  auto& s = fake_hd::sdk();
  const auto give = [&](const auto& values) {
    for (double x : values) *v++ = x;
  };
  if (what <= HD_CURRENT_FORCE && !s.in_frame) ++s.misuse;
  if (what == HD_CURRENT_POSITION) s.calls.push_back("read");
  if (what == HD_CURRENT_POSITION) give(s.position);
  if (what == HD_CURRENT_VELOCITY) give(s.velocity);
  if (what == HD_CURRENT_TRANSFORM) give(s.transform);
  if (what == HD_NOMINAL_MAX_FORCE) *v = s.max_force;
  if (what == HD_NOMINAL_MAX_CONTINUOUS_FORCE) *v = s.continuous;
  if (what == HD_NOMINAL_MAX_STIFFNESS) *v = s.stiffness;
  if (what == HD_USABLE_WORKSPACE_DIMENSIONS) give(s.workspace);
}
inline void hdGetIntegerv(HDenum, HDint* v) {
  *v = fake_hd::sdk().buttons;
}
inline void hdSetDoublev(HDenum what, const HDdouble* v) {
  auto& s = fake_hd::sdk();
  if (!s.in_frame) ++s.misuse;
  (what == HD_CURRENT_FORCE ? s.frame_force : s.frame_torque) = {v[0], v[1], v[2]};
  s.calls.push_back(what == HD_CURRENT_FORCE ? "force" : "torque");
}
inline void hdSetSchedulerRate(HDulong rate) {
  fake_hd::sdk().rate = rate;
}
inline HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data, HDushort) {
  auto& s = fake_hd::sdk();
  s.calls.push_back("schedule");
  s.callback = callback;
  s.callback_data = data;
  return 3;
}
inline void hdStartScheduler() {
  auto& s = fake_hd::sdk();
  s.calls.push_back("start scheduler");
  if (!s.calls_back) return;
  s.stop_thread = false;
  s.thread = std::thread([&s] {
    while (!s.scheduler_runs) std::this_thread::yield();  // s.thread is assigned
    while (!s.stop_thread && s.callback(s.callback_data) == HD_CALLBACK_CONTINUE)
      std::this_thread::sleep_for(std::chrono::microseconds(200));
  });
  s.scheduler_runs = true;
}
inline void hdStopScheduler() {
  auto& s = fake_hd::sdk();
  s.stop_thread = true;
  if (s.thread.joinable()) s.thread.join();
  s.scheduler_runs = false;
  s.calls.push_back("stop scheduler");
}
inline void hdUnschedule(HDSchedulerHandle) {
  fake_hd::sdk().calls.push_back("unschedule");
}
