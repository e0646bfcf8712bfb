// DIG_BOTH marks a function that runs on the processor and on a CUDA device.

#ifndef DIG_OFFLINE_DEM_LAW_BOTH_H
#define DIG_OFFLINE_DEM_LAW_BOTH_H

#ifdef __CUDACC__
#define DIG_BOTH __host__ __device__
#else
#define DIG_BOTH
#endif

#endif // DIG_OFFLINE_DEM_LAW_BOTH_H
