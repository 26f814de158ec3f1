// The law of a scene as the checker has it: its parameters enclosed.
#pragma once

#include "cradle/core/certify/checker.hpp"
#include "cradle/tools/setup/initial_state.hpp"

namespace cradle::tools {

template <Enclosing N> CertainLaw<N> certain_law(const Scene& scene) {
  using Kind = typename CertainLaw<N>::Kind;
  CertainLaw<N> law;
  if (scene.law.type == LawType::sticky) {
    law.kind = Kind::sticky;
    return law;
  }
  if (scene.law.type == LawType::wet) {
    law.kind = Kind::wet;
    law.loss = number<N>(scene.law.loss);
    return law;
  }
  law.restitution = number<N>(scene.law.restitution);
  law.elastic = scene.law.restitution == Decimal("1");
  if (scene.run.collapse == tools::scene::CollapsePolicy::merge) {
    law.kind = Kind::merging;
    law.merge_speed = number<N>(scene.run.merge_speed);
    return law;
  }
  // To elastic particles a cut-off does nothing; under gravity it holds for walls too.
  const bool acts = !law.elastic || scene.gravity.acts();
  if (acts && scene.law.cutoff > Decimal("0")) law.cutoff = number<N>(scene.law.cutoff);
  if (!law.elastic && scene.law.cutoff_exponent) law.cutoff_exponent = number<N>(*scene.law.cutoff_exponent);
  if (acts && scene.run.collapse == tools::scene::CollapsePolicy::contact_time)
    law.contact_time = number<N>(scene.run.contact_time);
  return law;
}

}  // namespace cradle::tools
