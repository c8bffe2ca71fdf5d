// The two-bone and aim jobs of ozz-animation on the inputs of our bench `ik`, in nanoseconds a solve.
//
// tools/bench_ik_ozz.py builds and runs this beside our bench; give it an ozz-animation checkout.

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "ozz/animation/runtime/ik_aim_job.h"
#include "ozz/animation/runtime/ik_two_bone_job.h"
#include "ozz/base/maths/simd_math.h"
#include "ozz/base/maths/simd_quaternion.h"

using namespace ozz::math;

namespace {

// The job must not be hoisted out of the loop: its inputs may change each time, and its outputs are used.
template <typename T>
void opaque(T& value) {
  asm volatile("" : "+m"(value) : : "memory");
}

template <typename Job>
double ns_per_run(Job& job, double seconds) {
  using Clock = std::chrono::steady_clock;
  constexpr int kRuns = 20000;
  double best = 1e30;
  const auto start = Clock::now();
  while (std::chrono::duration<double>(Clock::now() - start).count() < seconds) {
    const auto before = Clock::now();
    for (int i = 0; i < kRuns; ++i) {
      opaque(job);
      if (!job.Run()) std::exit(1);
    }
    const double ns = std::chrono::duration<double, std::nano>(Clock::now() - before).count() / kRuns;
    if (ns < best) best = ns;
  }
  return best;
}

Float4x4 at(float x, float y, float z) {
  return Float4x4::Translation(simd_float4::Load(x, y, z, 1.f));
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 1.0;
  const Float4x4 upper = at(0.12f, 1.28f, 0.f);
  const Float4x4 middle = at(0.36f, 1.28f, 0.01f);
  const Float4x4 end = at(0.60f, 1.28f, 0.f);
  SimdQuaternion upper_turn, middle_turn;
  bool reached = false;

  ozz::animation::IKTwoBoneJob bones;
  bones.target = simd_float4::Load(0.4f, 1.1f, 0.25f, 0.f);
  bones.mid_axis = simd_float4::Load(0.f, 1.f, 0.f, 0.f);
  bones.pole_vector = simd_float4::Load(0.18f, -1.28f, -1.f, 0.f);
  bones.start_joint = &upper;
  bones.mid_joint = &middle;
  bones.end_joint = &end;
  bones.start_joint_correction = &upper_turn;
  bones.mid_joint_correction = &middle_turn;
  bones.reached = &reached;
  std::printf("two bones and a pole %.1f\n", ns_per_run(bones, seconds));
  if (!reached) return 1;

  const Float4x4 joint = at(0.f, 1.5f, 0.f);
  ozz::animation::IKAimJob aim;
  aim.target = simd_float4::Load(1.f, 1.2f, 2.f, 0.f);
  aim.forward = simd_float4::z_axis();
  aim.up = simd_float4::y_axis();
  aim.pole_vector = simd_float4::y_axis();
  aim.joint = &joint;
  aim.joint_correction = &upper_turn;
  aim.reached = &reached;
  std::printf("aim, with a direction that stays up %.1f\n", ns_per_run(aim, seconds));
  return reached ? 0 : 1;
}
