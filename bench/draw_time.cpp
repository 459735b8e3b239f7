#include "draw_time.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstdint>
#include <ctime>

namespace crease::bench {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

DrawTime time_drawing(int times, const std::function<void()>& draw) {
  GLuint query = 0;
  glGenQueries(1, &query);
  glFinish();
  const std::clock_t begin = std::clock();
  glBeginQuery(GL_TIME_ELAPSED, query);
  for (int i = 0; i < times; ++i) draw();
  glEndQuery(GL_TIME_ELAPSED);
  glFinish();
  const std::clock_t end = std::clock();
  std::uint64_t nanoseconds = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
  glDeleteQueries(1, &query);
  return {1e3 * double(end - begin) / CLOCKS_PER_SEC / times, 1e-6 * double(nanoseconds) / times};
}

DrawTime median(const std::vector<DrawTime>& rounds) {
  std::vector<double> processor, gpu;
  for (const DrawTime& round : rounds) {
    processor.push_back(round.processor_ms);
    gpu.push_back(round.gpu_ms);
  }
  return {median(std::move(processor)), median(std::move(gpu))};
}

}  // namespace crease::bench
