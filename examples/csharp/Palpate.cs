// The C interface of palpate in C#: structs as in palpate/c/palpate.h, and its functions. The structs are blittable, so
// that .NET, Mono and Unity pass them without a copy. libpalpate_c must be where the system finds libraries; in Unity,
// put it into Assets/Plugins.
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Palpate
{
    [StructLayout(LayoutKind.Sequential)]
    public struct Vector
    {
        public double X, Y, Z;
        public Vector(double x, double y, double z) { X = x; Y = y; Z = z; }
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct Material
    {
        public uint StructSize, InterfaceVersion;
        public IntPtr Region;  // null: everywhere
        public double YoungsModulus, PoissonRatio, Density;
    }

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate int ProgressCallback(IntPtr user, IntPtr stage, double fraction);

    [StructLayout(LayoutKind.Sequential)]
    public struct Setup
    {
        public uint StructSize, InterfaceVersion;
        public IntPtr Policy;
        public IntPtr Materials;
        public ulong MaterialCount;
        public IntPtr Progress;  // Marshal.GetFunctionPointerForDelegate
        public IntPtr ProgressUser;
        public ulong MemoryLimit;
        public int Threads, Repair, ForceErrorPlaces, QuasiStatic, Columns, ComplianceSlots;
        public double Step, MassDamping;
        public IntPtr CacheFile;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct Tool
    {
        public uint StructSize, InterfaceVersion;
        public int Kind, Reserved;
        public double Radius, HalfLength;
        public Vector Axis, Edge;
        public double Toughness, CutSpacing;

        public static Tool Sphere(double radius)
        {
            return new Tool { StructSize = (uint)Marshal.SizeOf(typeof(Tool)), InterfaceVersion = Native.Version, Radius = radius };
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct ToolState
    {
        public uint StructSize, InterfaceVersion;
        public Vector Position, Velocity;
        public double W, X, Y, Z;  // orientation
        public double Time, Now;
        public uint Buttons, Given;

        public const uint HasOrientation = 1, HasVelocity = 2, HasNow = 4, Unreadable = 8;

        public static ToolState Create()
        {
            return new ToolState { StructSize = (uint)Marshal.SizeOf(typeof(ToolState)), InterfaceVersion = Native.Version };
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct ToolForce
    {
        public uint StructSize, InterfaceVersion;
        public Vector Force, Torque, ContactForce;
        public double ErrorExpected, ErrorBound;
        public uint Status;
        public int Contacts;

        public static ToolForce Create()
        {
            return new ToolForce { StructSize = (uint)Marshal.SizeOf(typeof(ToolForce)), InterfaceVersion = Native.Version };
        }
    }

    // Only for errors, so that its arrays may be copied.
    [StructLayout(LayoutKind.Sequential)]
    public struct ErrorInfo
    {
        public uint StructSize, InterfaceVersion;
        public int Kind, IdsOf;
        public long Count;
        [MarshalAs(UnmanagedType.ByValArray, SizeConst = 16)] public long[] Ids;
        public int IdCount, Reserved;
        public double Value, Threshold;
        [MarshalAs(UnmanagedType.ByValArray, SizeConst = 1024)] public byte[] Text;
        [MarshalAs(UnmanagedType.ByValArray, SizeConst = 512)] public byte[] Hint;
    }

    // What a call refused.
    public sealed class PalpateException : Exception
    {
        public readonly int Kind;
        public readonly long[] Ids;
        PalpateException(string message, int kind, long[] ids) : base(message) { Kind = kind; Ids = ids; }

        public static void Check(int error)
        {
            if (error == 0) return;
            var info = new ErrorInfo { StructSize = (uint)Marshal.SizeOf(typeof(ErrorInfo)), InterfaceVersion = Native.Version };
            Native.palpate_last_error(ref info);
            var ids = new long[info.IdCount];
            Array.Copy(info.Ids, ids, ids.Length);
            string name = Marshal.PtrToStringAnsi(Native.palpate_error_name(error));
            throw new PalpateException(name + ": " + Decode(info.Text) + ". " + Decode(info.Hint), error, ids);
        }
        static string Decode(byte[] text) { return Encoding.UTF8.GetString(text, 0, Array.IndexOf(text, (byte)0)); }
    }

    public static class Native
    {
        public const uint Version = 1;
        const string Library = "palpate_c";
        const CallingConvention C = CallingConvention.Cdecl;

        [DllImport(Library, CallingConvention = C)] public static extern uint palpate_interface_version();
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_last_error(ref ErrorInfo info);
        [DllImport(Library, CallingConvention = C)] public static extern IntPtr palpate_error_name(int kind);
        [DllImport(Library, CallingConvention = C)] public static extern IntPtr palpate_status_name(int bit);
        [DllImport(Library, CallingConvention = C)] public static extern UIntPtr palpate_policy_count();
        [DllImport(Library, CallingConvention = C)] public static extern IntPtr palpate_policy_name(UIntPtr number);

        [DllImport(Library, CallingConvention = C)] public static extern int palpate_mesh_read(byte[] path, double scale, out IntPtr mesh);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_mesh_from_arrays(
            double[] positions, UIntPtr nodes, int[] cells, UIntPtr cellCount, int nodesPerCell, int[] regions, out IntPtr mesh);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_mesh_add_group(
            IntPtr mesh, byte[] name, int[] nodes, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] public static extern void palpate_mesh_destroy(IntPtr mesh);

        [DllImport(Library, CallingConvention = C)] public static extern int palpate_scene_create(out IntPtr scene);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_scene_fix(IntPtr scene, byte[] group);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_scene_touch(IntPtr scene, byte[] group, double radius);
        [DllImport(Library, CallingConvention = C)] public static extern void palpate_scene_destroy(IntPtr scene);

        [DllImport(Library, CallingConvention = C)] public static extern int palpate_tissue_create(
            IntPtr mesh, IntPtr scene, ref Setup setup, out IntPtr tissue);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_tissue_report(
            IntPtr tissue, byte[] text, UIntPtr capacity, out UIntPtr length);
        [DllImport(Library, CallingConvention = C)] public static extern void palpate_tissue_destroy(IntPtr tissue);

        [DllImport(Library, CallingConvention = C)] public static extern int palpate_session_create(
            IntPtr tissue, ref Tool tools, UIntPtr count, IntPtr options, out IntPtr session);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_session_tick(
            IntPtr session, ref ToolState states, UIntPtr ticks, ref ToolForce forces);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_session_surface_size(
            IntPtr session, out UIntPtr points, out UIntPtr triangles);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_session_triangles(
            IntPtr session, int[] points, UIntPtr capacity);
        [DllImport(Library, CallingConvention = C)] public static extern int palpate_session_read_surface(
            IntPtr session, float[] positions, float[] normals, UIntPtr capacity);
        [DllImport(Library, CallingConvention = C)] public static extern void palpate_session_destroy(IntPtr session);

        public static byte[] Text(string text) { return Encoding.UTF8.GetBytes(text + "\0"); }
    }
}
