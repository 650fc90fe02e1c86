// Probabilities of actions, and draws by them.
#pragma once

namespace synpo {

// p = softmax(scores / temperature), both [n], in double; returns log sum exp(scores / temperature), so that log p =
// scores / temperature minus it.
double softmax(const float* scores, int n, double temperature, double* p);

// The place in p [n] that a number `uniform` from [0, 1) draws.
int draw(const double* p, int n, double uniform);

}  // namespace synpo
