// Constitutive law of rock in motion, from F = I + H. Whole rock: fixed corotated elasticity (Stomakhin et al.
// 2012; Arenite eq. 5). Broken rock: cohesionless Drucker-Prager cone (Klar et al. 2016) on the corotated
// strain.

// Rotation R of the polar decomposition f = R S, by Newton's iteration (Higham 1986): four steps reach single precision for
// strains up to a third.
mat3 rotation_of(mat3 f)
{
    mat3 r = f;
    for (int step = 0; step < 4; step++) {
        mat3 cofactor = mat3(cross(r[1], r[2]), cross(r[2], r[0]), cross(r[0], r[1]));
        r = 0.5 * (r + cofactor / dot(r[0], cofactor[0]));
    }
    return r;
}

// e = S - I for F = R S, symmetrised.
mat3 strain_of(mat3 r, mat3 f)
{
    mat3 s = transpose(r) * f;
    s = 0.5 * (s + transpose(s));
    return s - mat3(1.0);
}

// det(I + e) - 1 without cancellation.
float volume_strain(mat3 e)
{
    float trace = e[0][0] + e[1][1] + e[2][2];
    float second = e[0][0] * e[1][1] - e[0][1] * e[1][0] + e[1][1] * e[2][2] - e[1][2] * e[2][1] + e[0][0] * e[2][2] - e[0][2] * e[2][0];
    return trace + second + determinant(e);
}

// Kirchhoff stress in the rotated frame, R^T tau R = 2 mu (e + e^2) + lambda (J - 1) J I.
mat3 body_stress(mat3 e)
{
    float j = volume_strain(e);
    return 2.0 * k.mu * (e + e * e) + mat3(k.lambda * j * (1.0 + j));
}

// Kirchhoff stress that acts: reduced by the rebound factor while unloading fast, so that rock does not bounce like rubber, plus
// viscous stress. `g` is the velocity gradient.
mat3 acting_stress(mat3 stress, mat3 g)
{
    float power = dot(stress[0], g[0]) + dot(stress[1], g[1]) + dot(stress[2], g[2]);
    float size = sqrt(dot(stress[0], stress[0]) + dot(stress[1], stress[1]) + dot(stress[2], stress[2]));
    float back = size > 0.0 ? clamp(-power / (size * MPM_REBOUND_RATE), 0.0, 1.0) : 0.0;
    return stress * (1.0 + back * (k.rebound - 1.0)) + k.viscosity * (g + transpose(g));
}

// Largest eigenvalue of a symmetric matrix.
float most_tension(mat3 s)
{
    float q = (s[0][0] + s[1][1] + s[2][2]) / 3.0;
    mat3 d = s - mat3(q);
    float off = d[1][0] * d[1][0] + d[2][0] * d[2][0] + d[2][1] * d[2][1];
    float p = sqrt((d[0][0] * d[0][0] + d[1][1] * d[1][1] + d[2][2] * d[2][2] + 2.0 * off) / 6.0);
    if (p <= 1e-6 * abs(q))
        return q;
    return q + 2.0 * p * cos(acos(clamp(0.5 * determinant(d) / (p * p * p), -1.0, 1.0)) / 3.0);
}

// Return mapping of broken rock (Klar et al. 2016): strain on the Drucker-Prager cone. `apart` is the volume strain by which it has
// come apart; it must be compressed by as much before it resists again.
mat3 slide(mat3 e, inout float apart)
{
    float trace = e[0][0] + e[1][1] + e[2][2] + apart;
    if (trace >= 0.0) {
        apart = trace;
        return mat3(0.0);
    }
    apart = 0.0;
    mat3 shear = e - mat3((e[0][0] + e[1][1] + e[2][2]) / 3.0);
    float size = sqrt(dot(shear[0], shear[0]) + dot(shear[1], shear[1]) + dot(shear[2], shear[2]));
    float allowed = -k.alpha * (3.0 * k.lambda + 2.0 * k.mu) / (2.0 * k.mu) * trace;
    float left = size > allowed ? allowed / size : 1.0;
    return shear * left + mat3(trace / 3.0);
}
