/* Andrews' squeezing mechanism as a differential–algebraic equation of index 3, in 27 unknowns:
   seven angles, their velocities and accelerations, six multipliers (Hairer and Wanner, Solving
   ODEs II, section VII.7). The right side of RADAU5 in R's deSolve. */
#include <math.h>

static double none[1];

void start(void (*read)(int *, double *)) {
    int count = 1;
    read(&count, none);
}

static const double m1 = .04325, m2 = .00365, m3 = .02373, m4 = .00706, m5 = .07050, m6 = .00706,
    m7 = .05498, i1 = 2.194e-6, i2 = 4.410e-7, i3 = 5.255e-6, i4 = 5.667e-7, i5 = 1.169e-5,
    i6 = 5.667e-7, i7 = 1.912e-5, xa = -.06934, ya = -.00227, xb = -.03635, yb = .03273,
    xc = .014, yc = .072, d = .028, da = .0115, e = .02, ea = .01421, zf = .02, fa = .01421,
    rr = .007, ra = .00092, ss = .035, sa = .01874, sb = .01043, sc = .018, sd = .02, zt = .04,
    ta = .02308, tb = .00916, u = .04, ua = .01228, ub = .00449, c0 = 4530., l0 = .07785,
    mom = .033;

void derivs(int *count, double *t, double *y, double *dy, double *out, int *ip) {
    const double *q = y, *v = y + 7, *w = y + 14, *lam = y + 21;
    double be = q[0], th = q[1], ga = q[2], ph = q[3], de = q[4], om = q[5], ep = q[6];
    double bep = v[0], thp = v[1], php = v[3], dep = v[4], omp = v[5], epp = v[6];
    double sibe = sin(be), cobe = cos(be), siga = sin(ga), coga = cos(ga), side = sin(de),
        code = cos(de), siep = sin(ep), coep = cos(ep), sith = sin(th), coth = cos(th),
        siph = sin(ph), coph = cos(ph), siom = sin(om), coom = cos(om);
    double sibeth = sin(be + th), cobeth = cos(be + th), siphde = sin(ph + de),
        cophde = cos(ph + de), siomep = sin(om + ep), coomep = cos(om + ep);
    double m[7][7] = {{0}}, f[7], gp[6][7] = {{0}};
    m[0][0] = m1 * ra * ra + m2 * (rr * rr - 2 * da * rr * coth + da * da) + i1 + i2;
    m[1][0] = m[0][1] = m2 * (da * da - da * rr * coth) + i2;
    m[1][1] = m2 * da * da + i2;
    m[2][2] = m3 * (sa * sa + sb * sb) + i3;
    m[3][3] = m4 * (e - ea) * (e - ea) + i4;
    m[4][3] = m[3][4] = m4 * ((e - ea) * (e - ea) + zt * (e - ea) * siph) + i4;
    m[4][4] = m4 * (zt * zt + 2 * zt * (e - ea) * siph + (e - ea) * (e - ea))
        + m5 * (ta * ta + tb * tb) + i4 + i5;
    m[5][5] = m6 * (zf - fa) * (zf - fa) + i6;
    m[6][5] = m[5][6] = m6 * ((zf - fa) * (zf - fa) - u * (zf - fa) * siom) + i6;
    m[6][6] = m6 * ((zf - fa) * (zf - fa) - 2 * u * (zf - fa) * siom + u * u)
        + m7 * (ua * ua + ub * ub) + i6 + i7;
    double xd = sd * coga + sc * siga + xb, yd = sd * siga - sc * coga + yb;
    double lang = sqrt((xd - xc) * (xd - xc) + (yd - yc) * (yd - yc));
    double force = -c0 * (lang - l0) / lang, fx = force * (xd - xc), fy = force * (yd - yc);
    f[0] = mom - m2 * da * rr * thp * (thp + 2 * bep) * sith;
    f[1] = m2 * da * rr * bep * bep * sith;
    f[2] = fx * (sc * coga - sd * siga) + fy * (sd * coga + sc * siga);
    f[3] = m4 * zt * (e - ea) * dep * dep * coph;
    f[4] = -m4 * zt * (e - ea) * php * (php + 2 * dep) * coph;
    f[5] = -m6 * u * (zf - fa) * epp * epp * coom;
    f[6] = m6 * u * (zf - fa) * omp * (omp + 2 * epp) * coom;
    gp[0][0] = -rr * sibe + d * sibeth;
    gp[0][1] = d * sibeth;
    gp[0][2] = -ss * coga;
    gp[1][0] = rr * cobe - d * cobeth;
    gp[1][1] = -d * cobeth;
    gp[1][2] = -ss * siga;
    gp[2][0] = -rr * sibe + d * sibeth;
    gp[2][1] = d * sibeth;
    gp[2][3] = -e * cophde;
    gp[2][4] = -e * cophde + zt * side;
    gp[3][0] = rr * cobe - d * cobeth;
    gp[3][1] = -d * cobeth;
    gp[3][3] = -e * siphde;
    gp[3][4] = -e * siphde - zt * code;
    gp[4][0] = -rr * sibe + d * sibeth;
    gp[4][1] = d * sibeth;
    gp[4][5] = zf * siomep;
    gp[4][6] = zf * siomep - u * coep;
    gp[5][0] = rr * cobe - d * cobeth;
    gp[5][1] = -d * cobeth;
    gp[5][5] = -zf * coomep;
    gp[5][6] = -zf * coomep - u * siep;
    for (int i = 0; i < 14; i++) dy[i] = y[i + 7];
    for (int i = 0; i < 7; i++) {
        double sum = -f[i];
        for (int j = 0; j < 7; j++) sum += m[i][j] * w[j];
        for (int k = 0; k < 6; k++) sum += gp[k][i] * lam[k];
        dy[14 + i] = sum;
    }
    dy[21] = rr * cobe - d * cobeth - ss * siga - xb;
    dy[22] = rr * sibe - d * sibeth + ss * coga - yb;
    dy[23] = rr * cobe - d * cobeth - e * siphde - zt * code - xa;
    dy[24] = rr * sibe - d * sibeth + e * cophde - zt * side - ya;
    dy[25] = rr * cobe - d * cobeth - zf * coomep - u * siep - xa;
    dy[26] = rr * sibe - d * sibeth - zf * siomep + u * coep - ya;
}
