/* Deposits: cones at the angle of repose, round, without steps; every crumb accounted for. */
#include "heap.h"

#include <stdio.h>

static const double pi = 3.14159265358979323846;

/* Slope of the heights of columns within 10 degrees of an azimuth and a rotation of it by quarter turns, by
 * least squares over the radius, from a quarter to 85 % of the foot's. */
static double flank(const struct heap *p, const int *height, double azimuth, double cx, double cy, double ground)
{
    double foot = 0, n = 0, sr = 0, sz = 0, srr = 0, srz = 0;
    for (int y = 0; y < p->n[1]; y++)
        for (int x = 0; x < p->n[0]; x++) {
            if (height[y * p->n[0] + x] > ground)
                n++;
        }
    foot = sqrt(n / pi);
    n = 0;
    for (int y = 0; y < p->n[1]; y++)
        for (int x = 0; x < p->n[0]; x++) {
            double dx = x + 0.5 - cx, dy = y + 0.5 - cy, r = hypot(dx, dy), a = atan2(dy, dx) - azimuth;
            a -= pi / 2 * round(a / (pi / 2));
            if (fabs(a) > 10 * pi / 180 || r < 0.25 * foot || r > 0.8 * foot)
                continue;
            n++, sr += r, sz += height[y * p->n[0] + x], srr += r * r, srz += r * height[y * p->n[0] + x];
        }
    return atan(-(n * srz - sr * sz) / (n * srr - sr * sr)) * 180 / pi;
}

static void cone(double repose, int frames, int per_frame)
{
    const int n[3] = {64, 64, 48};
    struct heap p = heap_begin(n, 0.5, repose);
    heap_box(&p, (int[]){0, 0, 0}, (int[]){64, 64, 2});
    for (int f = 0; f < frames; f++) {
        uint32_t ids[1024];
        for (int i = 0; i < per_frame; i++) {
            uint32_t hash = random_hash(3, (uint32_t)f, (uint32_t)i, 0);
            ids[i] = p.next_id;
            heap_add(&p, 30 + (int)(hash & 3), 30 + (int)(hash >> 2 & 3), 40 + (int)(hash >> 4 & 3));
        }
        heap_step(&p, ids, (size_t)per_frame, 1);
    }
    int *z = heap_heights(&p);
    double S=0,G=0,Tr=0,N=0, H2=0, hist[20]={0};
    for (int y = 6; y < 58; y++) for (int x = 6; x < 58; x++) {
        double r = hypot(x+1-32,y+1-32); if (r<9||r>17) continue;
        #define B(x0,y0,w,h) ({double q=0; for(int j=0;j<h;j++)for(int i=0;i<w;i++)q+=z[(y0+j)*64+x0+i]; q/(w*h);})
        double o=B(x,y,2,2),e=B(x+2,y-1,3,4),w=B(x-3,y-1,3,4),nn=B(x-1,y+2,4,3),ss=B(x-1,y-3,4,3);
        double gx=fmax(fmax(o-e,o-w),0)/2.5, gy=fmax(fmax(o-nn,o-ss),0)/2.5;
        double cxx=(w-e)/5, cyy=(ss-nn)/5; double s1=hypot(gx,gy); S+=s1; G+=hypot(cxx,cyy); N++; hist[(int)(s1*10)>19?19:(int)(s1*10)]++;
        double l=o-(e+w+nn+ss)/4; Tr+=l; H2+=l*l;
    }
    printf("measured %.3f central %.3f tan %.3f  lap %.3f sd %.3f\n", S/N, G/N, tan(repose*pi/180), Tr/N, sqrt(H2/N));
    for(int i=0;i<20;i++)printf("%.3f ",hist[i]/N); printf("\n");
    for (int i = 0; i < 64; i++)
        printf("%d ", z[32 * 64 + i]);
    printf("\n");
    for (int i = 0; i < 64; i++)
        printf("%d ", z[i * 64 + i]);
    printf("\n");
    print_message("# %g deg: axes %.2f, diagonals %.2f; left %llu of %d, slid %llu, rounds %d\n", repose,
                  flank(&p, z, 0, 32, 32, 2), flank(&p, z, pi / 4, 32, 32, 2), (unsigned long long)p.left,
                  frames * per_frame, (unsigned long long)p.slid, p.most_rounds);
    free(z);
    heap_end(&p);
}

static void wedge(double repose, int frames, int per_frame)
{
    const int n[3] = {64, 64, 48};
    struct heap p = heap_begin(n, 0.5, repose);
    heap_box(&p, (int[]){0, 0, 0}, (int[]){64, 64, 2});
    heap_box(&p, (int[]){0, 0, 2}, (int[]){8, 64, 36});
    for (int f = 0; f < frames; f++) {
        uint32_t ids[1024];
        for (int i = 0; i < per_frame; i++) {
            uint32_t hash = random_hash(3, (uint32_t)f, (uint32_t)i, 0);
            ids[i] = p.next_id;
            heap_add(&p, 8 + (int)(hash & 1), (int)(hash >> 2 & 63), 40 + (int)(hash >> 14 & 3));
        }
        heap_step(&p, ids, (size_t)per_frame, 1);
    }
    int *z = heap_heights(&p);
    double m[64];
    for (int x = 0; x < 64; x++) { m[x]=0; for (int y=20;y<44;y++) m[x]+=z[y*64+x]/24.; printf("%.1f ", m[x]);}
    int b=9,e=9; while(m[e]>4)e++; e-=2; b=9+(e-9)/6;
    printf("\n# wedge %g: slope %.2f from %d to %d left %llu slid %llu\n", repose, atan((m[b]-m[e])/(e-b))*180/pi, b,e,(unsigned long long)p.left, (unsigned long long)p.slid);
    free(z);
    heap_end(&p);
}

static void cones(void **state)
{
    (void)state;
    if (getenv("CONE")) {
    cone(25, 100, 60);
    cone(34, 100, 80);
    cone(34, 300, 20);
    cone(34, 20, 400);
    cone(40, 100, 100);
    }
    if (getenv("WEDGE")) {
    wedge(25, 60, 200);
    wedge(34, 60, 200);
    wedge(34, 200, 60);
    wedge(40, 60, 200);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cones)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
