// SPDX-License-Identifier: Apache-2.0
// A haptic device driver in one file. Copy it, fill in the four places marked FILL IN, build it against palpate::haptic.
// Unchanged, it drives a fake device, a point that moves up and down, so that it runs without hardware.
#include <palpate/haptic/haptic_tool.h>
#include <palpate_haptic_flags.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

namespace {

using palpate::haptic::Quaternion;
using palpate::haptic::Vec3;

volatile std::sig_atomic_t stop = 0;

struct Pose {
  Vec3 position;           // of the tip's centre, in the device's frame, m
  Quaternion orientation;  // x, y, z, w, unit length
  std::uint32_t buttons;
};

// FILL IN 1: the device. Open it, read its pose, write a force, close it.
class Device {
 public:
  Device() = default;                    // open the device here; throw std::runtime_error when it is missing
  ~Device() { write({0.0, 0.0, 0.0}); }  // release the force, then close
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // Largest force that the device may render, N, from its data sheet.
  static constexpr double kForceLimit = 3.3;

  // The newest pose; must not block for longer than a period of the loop.
  Pose read() {
    const std::chrono::duration<double> t = std::chrono::steady_clock::now() - start_;
    return {{0.0, 0.0, 0.008 * std::cos(2.0 * 3.14159265 * 0.5 * t.count())}, {0.0, 0.0, 0.0, 1.0}, 0};
  }

  // Force on the tool in the device's frame, N.
  void write(const Vec3& force) { written_ = force; }

 private:
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
  Vec3 written_{};
};

// FILL IN 2: the device's frame in the organ's frame. Here: the same axes, scale 1, the device's zero at `origin`. If you scale
// positions by s on the way to the organ, scale forces by s on the way back (power in = power out); rotate them back too.
struct Workspace {
  Vec3 origin{0.0, 0.0, 0.06};  // centre of the device's workspace in the organ's frame, m

  Vec3 toWorld(const Vec3& p) const { return {origin[0] + p[0], origin[1] + p[1], origin[2] + p[2]}; }
  Quaternion toWorld(const Quaternion& q) const { return q; }
  Vec3 toDevice(const Vec3& force_in_world) const { return force_in_world; }
};

struct Arguments {
  palpate::haptic::Options tool;
  Workspace workspace;
  double seconds = 0.0;  // 0: until stopped
};

[[noreturn]] void usage(int code) {
  std::fprintf(
      code == 0 ? stdout : stderr,
      "Usage: palpate-driver-template [--domain N] [--server-id N] [--organ-id N] [--tool N] [--seconds N] "
      "[--origin X Y Z] "
      "[--security FOLDER]\n");
  std::exit(code);
}

double number(int argc, char** argv, int& i) {
  char* end = nullptr;
  const double value = ++i < argc ? std::strtod(argv[i], &end) : 0.0;
  if (end == nullptr || end == argv[i] || *end != '\0' || !std::isfinite(value)) {
    std::fprintf(stderr, "%s needs a number\n", argv[i - 1]);
    usage(2);
  }
  return value;
}

// A whole number in [0, most].
std::uint32_t id(int argc, char** argv, int& i, std::uint32_t most) {
  const double value = number(argc, argv, i);
  if (!(value >= 0.0 && value <= most && value == std::floor(value))) {
    std::fprintf(stderr, "%s is %.10g, expected 0 to %u\n", argv[i - 1], value, most);
    usage(2);
  }
  return static_cast<std::uint32_t>(value);
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  arguments.tool.force_limit = Device::kForceLimit;
  arguments.tool.receive_priority = 65;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--help") == 0) usage(0);
    if (std::strcmp(argv[i], "--domain") == 0) {
      arguments.tool.domain = id(argc, argv, i, 230);
    } else if (std::strcmp(argv[i], "--server-id") == 0) {
      arguments.tool.server_id = id(argc, argv, i, palpate::haptic::kAnyServer - 1);
    } else if (std::strcmp(argv[i], "--organ-id") == 0) {
      arguments.tool.organ_id = id(argc, argv, i, 4294967295U);
    } else if (std::strcmp(argv[i], "--tool") == 0) {
      arguments.tool.tool_id = id(argc, argv, i, 3);
    } else if (std::strcmp(argv[i], "--security") == 0) {
      if (++i == argc) usage(2);
      arguments.tool.security = argv[i];
    } else if (std::strcmp(argv[i], "--seconds") == 0) {
      arguments.seconds = number(argc, argv, i);
    } else if (std::strcmp(argv[i], "--origin") == 0) {
      for (double& x : arguments.workspace.origin) x = number(argc, argv, i);
    } else {
      std::fprintf(stderr, "unknown option %s\n", argv[i]);
      usage(2);
    }
  }
  return arguments;
}

// Why there was no contact. nearest: of the tip's centre to the organ, m; infinite when no pose was used
void sayWhyNot(const Arguments& arguments, std::uint32_t flags, double nearest) {
  if ((flags & (PALPATE_HAPTIC_FLAG_TOOL_NOT_CONFIGURED | PALPATE_HAPTIC_FLAG_UNKNOWN_TOOL)) != 0)
    std::printf("the server has no tool %u: palpate-server --tools says how many it has\n",
                arguments.tool.tool_id);
  else if (!std::isfinite(nearest))
    std::printf("the server used no pose: force.flags is 0x%x, PALPATE_HAPTIC_FLAG_* says why\n",
                static_cast<unsigned>(flags));
  else
    std::printf("the tool never touched the organ: it stayed at least %.3g m from it; poses are in metres\n",
                nearest);
}

int run(const Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  Device device;
  palpate::haptic::HapticTool tool(arguments.tool);
  if (const std::string warning = tool.securityWarning(); !warning.empty())
    std::fprintf(stderr, "%s\n", warning.c_str());
  if (!tool.waitForServer(std::chrono::seconds(10))) {
    const std::string organ =
        arguments.tool.organ_id ? " with organ " + std::to_string(*arguments.tool.organ_id) : "";
    std::fprintf(stderr, "no server%s on DDS domain %u within 10 s\n", organ.c_str(), arguments.tool.domain);
    return 1;
  }
  // FILL IN 3: the rate. The loop may be faster than the server's 1 kHz: forceAt() extrapolates in between. Most devices call
  // back at their own rate; then put the loop's body into that callback.
  constexpr auto kPeriod = std::chrono::microseconds(500);
  double largest = 0.0;
  long answered = 0;
  std::uint32_t flags = 0;  // of the newest force
  const auto start = Clock::now();
  for (auto next = start + kPeriod; stop == 0; next += kPeriod) {
    const Pose pose = device.read();
    const Vec3 p = arguments.workspace.toWorld(pose.position);
    tool.send(p, arguments.workspace.toWorld(pose.orientation), pose.buttons);
    const palpate::haptic::Force force = tool.forceAt(p);
    // FILL IN 4: what else the device shows, e.g. force.flags on a lamp.
    device.write(arguments.workspace.toDevice(force.force));
    largest = std::fmax(largest, std::hypot(force.force[0], force.force[1], force.force[2]));
    if (force.gain > 0.0) {
      ++answered;
      flags = force.flags;
    }
    if (arguments.seconds > 0.0 && Clock::now() - start >= std::chrono::duration<double>(arguments.seconds))
      break;
    std::this_thread::sleep_until(next);
  }
  if (tool.leftOut() > 0)
    std::printf("%llu forces of another server were left out\n",
                static_cast<unsigned long long>(tool.leftOut()));
  if (tool.tooLate() > 0)
    std::printf("%llu times the newest answer had come more than 50 ms after its pose, and was ignored\n",
                static_cast<unsigned long long>(tool.tooLate()));
  const bool touched = answered > 0 && tool.nearest() == 0.0;
  if (answered > 0 && !touched) sayWhyNot(arguments, flags, tool.nearest());
  std::printf("largest force %.4f N; %ld periods with a force\n", largest, answered);
  return touched || (answered > 0 && stop != 0) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, [](int) { stop = 1; });
  std::signal(SIGTERM, [](int) { stop = 1; });
  try {
    return run(parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate-driver-template: %s\n", error.what());
    return 1;
  }
}
