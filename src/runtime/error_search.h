// The smallest error at which a view has no more triangles than it may, found by trying.
//
//   ErrorSearch search;
//   every update: if (view is another one) search.look_anew(max_triangles);
//                 ... ask for what search.trial() times the view's errors need ...
//                 ... show that from search.begin() on, and while (count > max_triangles) with
//                     larger errors, by coarser() ...
//                 search.tell(error, count, max_triangles, all is there);
//
// Errors are in multiples of what the view allows, so 1 is the least. A trial counts once all that
// it needs is there: then the next one is nearer. It begins with errors that hardly anything has.
#pragma once

#include <algorithm>
#include <cstddef>

namespace crease {

class ErrorSearch {
 public:
  void look_anew(std::size_t max_triangles);
  double trial() const { return trial_; }
  // Where to begin: while not all that the trial needs is there, what has fitted the last time.
  double begin(bool is_all_there) const { return is_all_there ? trial_ : std::max(trial_, good_); }
  // For one at which there are too many.
  static double coarser(double error, std::size_t triangles, std::size_t max_triangles);
  // At `error`, the trial or a coarser one, are so many triangles, not too many. `is_complete`: and
  // will be, for this view.
  void tell(double error, std::size_t triangles, std::size_t max_triangles, bool is_complete);
  bool has_ended() const { return has_ended_; }
  // What is shown has errors of so much; 0: of what is allowed.
  float shown() const { return good_ > 1 ? static_cast<float>(good_) : 0.0f; }

 private:
  static constexpr double kFirst = 1024;

  double finer(std::size_t max_triangles) const;

  double trial_ = kFirst;
  double good_ = kFirst;       // the last one told of
  double too_fine_ = 0;        // the largest of which it is known; 0: none
  std::size_t triangles_ = 0;  // at good_
  bool has_ended_ = false;
};

}  // namespace crease
