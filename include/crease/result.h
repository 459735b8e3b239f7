// How the outside world fails: a value or a Failure that says what, where and what to do.
//
//   Result<Imported> in = import_mesh("model.obj", {});
//   if (!in.ok()) return report(in.failure().message);  // "model.obj:17: face index 9 of 8"
//   use(in->mesh);
//
// Who takes the value without asking ends the program with the failure's message, as every broken
// promise does.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace crease {

// Values appear in logs and replies: add, never renumber.
enum class Error : std::uint16_t {
  CommandLine = 1,
  NotFound = 10,
  ReadFailed = 11,
  WriteFailed = 12,
  Replaced = 13,  // while it was read; open it again
  OutOfMemory = 14,
  NotCrease = 20,
  VersionTooNew = 21,
  Truncated = 22,
  BadChecksum = 23,
  OverLimit = 24,
  BadFormat = 25,    // the bytes are not what the format says
  BadValue = 26,     // a number that cannot be meant: NaN, infinite, index out of range
  NoTriangles = 27,  // readable, but nothing to work on
  NotSupported = 30,
  TargetNotMet = 40,
  Invalid = 50,  // an invariant does not hold
  Interrupted = 60,
};

struct Failure {
  Error error{};
  std::string message;  // one line: what, where (file, line, byte offset or block), what to do
};

// Says what was taken that is not there, and ends the program.
[[noreturn]] void end_without_value(const Failure& failure);
[[noreturn]] void end_without_failure();

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}
  Result(Failure failure) : state_(std::move(failure)) {}

  bool ok() const { return state_.index() == 0; }
  // ok() must hold.
  T& operator*() & { return *value(); }
  const T& operator*() const& { return *value(); }
  T&& operator*() && { return std::move(*value()); }
  T* operator->() { return value(); }
  const T* operator->() const { return value(); }
  // !ok() must hold.
  const Failure& failure() const {
    if (ok()) end_without_failure();
    return *std::get_if<1>(&state_);
  }

 private:
  T* value() {
    if (!ok()) end_without_value(failure());
    return std::get_if<0>(&state_);
  }
  const T* value() const {
    if (!ok()) end_without_value(failure());
    return std::get_if<0>(&state_);
  }

  std::variant<T, Failure> state_;
};

struct Done {};
using Status = Result<Done>;

inline Failure fail(Error error, std::string message) {
  return {error, std::move(message)};
}

}  // namespace crease
