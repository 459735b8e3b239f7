#include "crease/result.h"

#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>

namespace crease {
namespace {

// What a process says before it ends with SIGABRT; empty: it ends otherwise.
template <typename Body>
std::string last_words(const Body& body) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    signal(SIGABRT, SIG_DFL);  // not the test runner's
    dup2(ends[1], STDERR_FILENO);
    body();
    _exit(0);
  }
  close(ends[1]);
  std::string words;
  char part[256];
  for (ssize_t got = 0; (got = read(ends[0], part, sizeof part)) > 0;) {
    words.append(part, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT ? words : std::string();
}

}  // namespace

TEST_CASE("who takes what a Result does not have ends with a message") {
  const Result<int> value = 3, none = fail(Error::NotFound, "no such file");
  CHECK(*value == 3);
  CHECK(none.failure().message == "no such file");
  int taken = 0;
  CHECK(last_words([&] { taken = *none; }) ==
        "broken promise: the value of a Result that failed: no such file\n");
  CHECK(last_words([&] { taken = static_cast<int>(value.failure().message.size()); }) ==
        "broken promise: the failure of a Result that is ok\n");
  CHECK(last_words([] {}).empty());
  CHECK(taken == 0);
}

}  // namespace crease
