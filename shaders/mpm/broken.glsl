// Is a particle a loose grain? At a joint that still holds its piece it is not, though it has cracked.

bool is_loose(float apart, uint joint)
{
    return apart >= 0.0 && joint == MPM_NO_JOINT;
}
