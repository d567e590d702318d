// Needs k.lambda, k.mu, k.dx.

// The diagonal of K at a node is the same on all axes: this times the sum of its cells' stiffness shares.
float diagonal_unit()
{
    return (k.lambda + 4.0 * k.mu) * k.dx / 9.0;
}
