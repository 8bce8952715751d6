#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace twinbench {

/// The last question and its answer, for all threads: for what goes by few things that are the same in one trial after another, and
/// takes longer than all the rest of a trial.
template <class Question, class Answer>
class LastAnswer {
 public:
  template <class Make>
  std::shared_ptr<const Answer> To(const Question& question, const Make& make) {
    const std::lock_guard lock(mutex_);
    if (!answer_ || question != question_) {
      answer_ = std::make_shared<const Answer>(make());
      question_ = question;
    }
    return answer_;
  }

 private:
  std::mutex mutex_;
  Question question_;
  std::shared_ptr<const Answer> answer_;
};

}  // namespace twinbench
