// Whether a particle is a loose grain. A cracked particle at a joint that still holds its piece is not.

// Bit in MPM_JOINT: the joint has parted its pieces. MPM_NO_JOINT has it set, too.
const uint PARTED = 0x80000000u;

bool is_loose(float apart, uint joint)
{
    return apart >= 0.0 && (joint & PARTED) != 0u;
}
