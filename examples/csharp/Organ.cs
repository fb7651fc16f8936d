// An organ with a tool, as a component of a game engine would hold it. In Unity: call Create in Awake, Tick in the thread
// of the device, ReadSurface in Update, and give Vertices and Normals to the mesh (three floats each).
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Palpate
{
    public sealed class Organ : IDisposable
    {
        IntPtr tissue, session;

        public readonly float[] Vertices, Normals;  // x y z per point, filled by ReadSurface
        public readonly int[] Triangles;            // three points each
        public readonly string Report;              // JSON

        // Progress is called with stage and fraction in this thread, and returns false to cancel; it may be null.
        public Organ(string meshFile, string policy, string fixedGroup, string touchedGroup, Material material, Tool tool,
                     Func<string, double, bool> progress)
        {
            IntPtr mesh = IntPtr.Zero, scene = IntPtr.Zero;
            try
            {
                PalpateException.Check(Native.palpate_mesh_read(Native.Text(meshFile), 1.0, out mesh));
                PalpateException.Check(Native.palpate_scene_create(out scene));
                PalpateException.Check(Native.palpate_scene_fix(scene, Native.Text(fixedGroup)));
                PalpateException.Check(Native.palpate_scene_touch(scene, Native.Text(touchedGroup), 0.0));
                CreateTissue(mesh, scene, policy, material, progress);
                PalpateException.Check(Native.palpate_session_create(tissue, ref tool, (UIntPtr)1, IntPtr.Zero, out session));
            }
            catch
            {
                Dispose();
                throw;
            }
            finally
            {
                Native.palpate_scene_destroy(scene);
                Native.palpate_mesh_destroy(mesh);
            }
            UIntPtr points, triangles;
            PalpateException.Check(Native.palpate_session_surface_size(session, out points, out triangles));
            Vertices = new float[3 * (int)points];
            Normals = new float[3 * (int)points];
            Triangles = new int[3 * (int)triangles];
            PalpateException.Check(Native.palpate_session_triangles(session, Triangles, (UIntPtr)Triangles.Length));
            Report = ReadReport();
        }

        void CreateTissue(IntPtr mesh, IntPtr scene, string policy, Material material, Func<string, double, bool> progress)
        {
            material.StructSize = (uint)Marshal.SizeOf(typeof(Material));
            material.InterfaceVersion = Native.Version;
            // An exception must not pass through C: it cancels, and is thrown again afterwards.
            Exception thrown = null;
            ProgressCallback callback = (user, stage, fraction) =>
            {
                try { return progress(Marshal.PtrToStringAnsi(stage), fraction) ? 0 : 1; }
                catch (Exception e) { thrown = e; return 1; }
            };
            var name = GCHandle.Alloc(Native.Text(policy), GCHandleType.Pinned);
            var materials = GCHandle.Alloc(material, GCHandleType.Pinned);
            try
            {
                var setup = new Setup
                {
                    StructSize = (uint)Marshal.SizeOf(typeof(Setup)),
                    InterfaceVersion = Native.Version,
                    Policy = name.AddrOfPinnedObject(),
                    Materials = materials.AddrOfPinnedObject(),
                    MaterialCount = 1,
                    Progress = progress == null ? IntPtr.Zero : Marshal.GetFunctionPointerForDelegate(callback)
                };
                int error = Native.palpate_tissue_create(mesh, scene, ref setup, out tissue);
                GC.KeepAlive(callback);
                if (thrown != null) throw thrown;
                PalpateException.Check(error);
            }
            finally
            {
                materials.Free();
                name.Free();
            }
        }

        // One tick, in the thread of the device: no allocation, no collection.
        public void Tick(ref ToolState state, ref ToolForce force)
        {
            int error = Native.palpate_session_tick(session, ref state, (UIntPtr)1, ref force);
            if (error != 0) PalpateException.Check(error);
        }

        // Fills Vertices and Normals, in the thread that draws: no allocation.
        public void ReadSurface()
        {
            int error = Native.palpate_session_read_surface(session, Vertices, Normals, (UIntPtr)Vertices.Length);
            if (error != 0) PalpateException.Check(error);
        }

        string ReadReport()
        {
            UIntPtr length;
            PalpateException.Check(Native.palpate_tissue_report(tissue, null, UIntPtr.Zero, out length));
            var text = new byte[(int)length + 1];
            PalpateException.Check(Native.palpate_tissue_report(tissue, text, (UIntPtr)text.Length, out length));
            return Encoding.UTF8.GetString(text, 0, (int)length);
        }

        public void Dispose()
        {
            Native.palpate_session_destroy(session);
            Native.palpate_tissue_destroy(tissue);
            session = tissue = IntPtr.Zero;
        }
    }
}
