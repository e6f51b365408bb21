/* drv PACKING case tol simd iterations : cases again, cold, fixed, predict */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "neighbours.h"
#include "nlcontact.h"
#include "packing_io.h"
#include "ordered.h"
static double now(void){struct timespec t;clock_gettime(CLOCK_MONOTONIC,&t);return t.tv_sec+1e-9*t.tv_nsec;}
static int cmp(const void*a,const void*b){double x=*(double*)a,y=*(double*)b;return x<y?-1:x>y;}
int main(int argc,char**argv){
  packing p; neighbours nb; char err[1024];
  const char*which=argv[2]; double tol=atof(argv[3]); int iters=atoi(argv[4]);
  double reach= argc>5?atof(argv[5]):NEIGHBOURS_REACH;
  if(packing_read(&p,argv[1],false,err,sizeof err)||neighbours_find(&nb,&p,reach,err,sizeof err)){puts(err);return 1;}
  if(getenv("ORDER")){const char*e=ordered_renumber(&p,&nb);if(e){puts(e);return 1;}} int64_t n=nb.count; nlc_particles part=packing_particles(&p);
  nlc_options o={.struct_size=sizeof o}; o.tolerance=tol; if(getenv("MODEL"))o.model=atoi(getenv("MODEL")); if(getenv("SIMD"))o.simd=atoi(getenv("SIMD")); if(!strcmp(which,"fixed"))o.method=NLC_METHOD_FIXED_POINT;
  size_t size=nlc_network_size(&part,n,&o); void*mem=malloc(size); nlc_network*net;
  nlc_status s=nlc_network_init(&net,mem,size,&part,nb.i,nb.j,n,&o,NULL); if(s){puts(nlc_strerror(s));return 1;}
  if(getenv("CACHE")){o.cache_size=nlc_cache_size(net);o.cache=malloc(o.cache_size);nlc_set_options(net,&o,NULL);printf("cache %.0f B/contact\n",(double)o.cache_size/n);}
  double*f=calloc(n,8),*g=calloc(n,8),*g0=calloc(n,8),*g1=calloc(n,8),*x=calloc(n,8);
  const double*N=(const double*)nb.normal;
  nlc_info info={.struct_size=sizeof info};
  double *gp=calloc(n,8),*xp=calloc(n,8);
  memcpy(x,nb.overlap,8*n);
  if(!strncmp(which,"loose",5)){ for(int64_t c=0;c<n;c++){ int in=1; for(int d=0;d<3;d++){double e=p.high[d]-p.low[d],at=(p.x[nb.i[c]][d]-p.low[d])/e; in=in&&at*at*at<0.01;} x[c]=in?x[c]:-fabs(x[c]);} if(!strcmp(which,"looseagain")) nlc_solve(net,f,g0,x,N,NULL);}
  nlc_options t=o; 
  if(!strcmp(which,"predict")||!strcmp(which,"step")){ /* two states before, 1e-4 apart */
    t.tolerance=1e-12; nlc_set_options(net,&t,NULL);
    for(int64_t c=0;c<n;c++) xp[c]=x[c]*(1-2e-4); nlc_solve(net,f,gp,xp,N,NULL);
    memcpy(g0,gp,8*n); for(int64_t c=0;c<n;c++) xp[c]=x[c]*(1-1e-4); nlc_solve(net,f,g0,xp,N,NULL);
    if(!strcmp(which,"predict")) for(int64_t c=0;c<n;c++) g0[c]=2*g0[c]-gp[c];
    nlc_set_options(net,&o,NULL);
  }
  if(!strcmp(which,"again")) nlc_solve(net,f,g0,x,N,NULL);
  if(!strcmp(which,"seq")){ double total=0; long sw=0; double top=0; for(int64_t c=0;c<n;c++) top=fmax(top,x[c]); int S=iters; double hh=argc>6?atof(argv[6]):1e-4;
    for(int st=0;st<S;st++){ for(int64_t c=0;c<n;c++) xp[c]=x[c]-hh*top*(S-st)*(0.5+0.5*(double)(c%3)/3)-hh*hh*top*(S-st)*(S-st)*0.5*(c%5);
      if(st>1) nlc_predict(g,gp,n,1,0); else memcpy(gp,g,8*n);
      double a=now(); nlc_solve(net,f,g,xp,N,&info); if(st>3){ total+=now()-a; sw+=info.sweeps; } }
    printf("seq %.1f ns/contact/step, %.2f sweeps\n",total*1e9/n/(S-4),(double)sw/(S-4)); return 0; }
  double best=1e9,all[1000]; int m=0;
  for(int it=0;it<iters;it++){ memcpy(g,g0,8*n); double a=now(); s=nlc_solve(net,f,g,x,N,&info); double b=now()-a; if(m<1000)all[m++]=b; if(b<best)best=b;}
  qsort(all,m,8,cmp);
  double fm=0; for(int64_t c=0;c<n;c++) fm=fmax(fm,f[c]);
  printf("%s %s n %ld active %ld size/contact %.0f: min %.1f median %.1f ns/contact sweeps %ld blocks %ld left_out %ld residual %.1e status %d\n",argv[1]+strlen(argv[1])-20,which,(long)n,(long)info.active,(double)size/n,best*1e9/n,all[m/2]*1e9/n,(long)info.sweeps,(long)info.blocks,(long)info.left_out,info.residual,s);
}
