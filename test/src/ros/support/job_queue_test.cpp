// Jobs of the simulation thread: what ends it, and what is only told to who asked.

#include "src/ros/support/job_queue.hpp"

#include <gtest/gtest.h>

namespace desert_sim {
namespace {

template <class Exception>
std::future<int> answer_of_a_job_that_throws(bool& ended) {
  std::future<int> answer;
  const Job job = make_job<int>([]() -> int { throw Exception("reason"); }, answer);
  ended = false;
  try {
    job.run();
  } catch (const Exception&) {
    ended = true;
  }
  return answer;
}

TEST(Jobs, ARefusalAndAFullDiskAreToldToWhoAskedAndDoNotEndTheSimulation) {
  bool ended = true;
  EXPECT_THROW(answer_of_a_job_that_throws<ConfigError>(ended).get(), ConfigError);
  EXPECT_FALSE(ended);
  EXPECT_THROW(answer_of_a_job_that_throws<WriteError>(ended).get(), WriteError);
  EXPECT_FALSE(ended) << "the terrain is as it was";
}

TEST(Jobs, AnyOtherFailureEndsTheSimulationToo) {
  bool ended = false;
  EXPECT_THROW(answer_of_a_job_that_throws<Error>(ended).get(), Error);
  EXPECT_TRUE(ended);
  EXPECT_THROW(answer_of_a_job_that_throws<CudaError>(ended).get(), CudaError);
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace desert_sim
